#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The null treatment on real traffic: every confirmed crash of the baselines of the studies given is
gone through again without a change, and must repeat itself to the bit: vehicles, time, states, pulses.

null_treatment.py --crashpulse PROGRAM STUDY... [--jobs N] [--folder F] [--output table.md]
                  [--crashes N] [--each N]

Writes a table by scenario and crash type, over all crashes, with those that have no checkpoint by
reason. Exit code 1 unless there are at least --crashes of them and --each of every scenario and every
frontal crash type, at most 5 % have no checkpoint, and all others reproduce."""
import argparse
import collections
import pathlib
import sqlite3
import subprocess
import sys

FRONTAL = ("front-front", "front-side", "front-rear")
WITHOUT = ("no_checkpoint", "inserted_late")


def table(title, groups):
    reasons = sorted({s for counts in groups.values() for s in counts} - {"reproduced"})
    lines = [f"| {title} | crashes | reproduced |" + "".join(f" {r} |" for r in reasons),
             "|---" * (3 + len(reasons)) + "|"]
    for name, counts in groups.items():
        lines.append(f"| {name} | {sum(counts.values())} | {counts['reproduced']} |" +
                     "".join(f" {counts[r]} |" for r in reasons))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--crashpulse", required=True)
    parser.add_argument("--folder", default=".", help="for the databases")
    parser.add_argument("--output")
    parser.add_argument("--jobs", default="2")
    parser.add_argument("--crashes", type=int, default=200)
    parser.add_argument("--each", type=int, default=40)
    parser.add_argument("studies", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()

    by_scenario, by_type, all_of_them = {}, {}, collections.Counter()
    crashes = 0
    for study in arguments.studies:
        db = pathlib.Path(arguments.folder) / f"null_treatment_{study.stem}.db"
        db.unlink(missing_ok=True)
        subprocess.run([arguments.crashpulse, "run", study, "--db", db, "--jobs", arguments.jobs],
                       check=True, stderr=subprocess.DEVNULL)
        connection = sqlite3.connect(db)
        # Every crash of the baseline, whether or not there is a null treatment of it.
        crashes += connection.execute("SELECT count(*) FROM crash").fetchone()[0]
        for scenario, crash_type, status, count in connection.execute(
                "SELECT s.name, c.crash_type, coalesce(n.status, 'missing'), count(*) FROM crash AS c "
                "JOIN replication AS r ON r.id = c.replication_id JOIN scenario AS s ON "
                "s.id = r.scenario_id LEFT JOIN null_treatment AS n ON n.crash_id = c.id "
                "GROUP BY s.number, 2, 3"):
            by_scenario.setdefault(scenario, collections.Counter())[status] += count
            by_type.setdefault(crash_type, collections.Counter())[status] += count
            all_of_them[status] += count
        connection.close()

    without = sum(all_of_them[reason] for reason in WITHOUT)
    other = crashes - without - all_of_them["reproduced"]
    by_type = {name: by_type[name] for name in sorted(by_type)}
    text = (table("scenario", by_scenario) + "\n" + table("crash type", by_type) + "\n" +
            f"{crashes} crashes: {all_of_them['reproduced']} reproduced to the bit, {without} "
            f"({100 * without / max(1, crashes):.1f} %) without a checkpoint, {other} not reproduced.\n")
    print(text)
    if arguments.output:
        pathlib.Path(arguments.output).write_text(
            "# The null treatment on real traffic\n\nMade by `cmake --build build --target "
            "null_treatment`: every confirmed crash of the baselines of\n"
            "`sumo_scenarios/null_treatment/study.yaml` and `town.yaml`, gone through again from a "
            "checkpoint without a change.\nReproduced: the same two vehicles, time, states and pulses, "
            "bit by bit. inserted_late: one of the two\nwas inserted less than 4 s before contact; "
            "no_checkpoint: none is 4 s before contact and 1 s before\nthe driver error began.\n\n" +
            text)
    few = [name for name in list(by_scenario) if sum(by_scenario[name].values()) < arguments.each]
    few += [name for name in FRONTAL
            if sum(by_type.get(name, {}).values()) < arguments.each and arguments.each > 0]
    wrong = []
    if crashes < arguments.crashes or few:
        wrong.append(f"too few crashes: {crashes}, fewer than {arguments.each} of {few}")
    if without > 0.05 * crashes:
        wrong.append("more than 5 % without a checkpoint")
    if other > 0:
        wrong.append(f"{other} not reproduced")
    sys.exit("; ".join(wrong) or 0)


main()
