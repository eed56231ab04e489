#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""agreement.py BUILD SOURCE [NETWORK ...]: SUMO's own collision reports against our contacts.

Runs every network named (default: all) at step lengths 0.1 and 0.05 s through 'crashpulse run' and
holds SUMO's collisions against what the database says of the same pair:
  matched      a crash of ours, at the same time (one step either way, or later where SUMO reports
               before first touch)
  explained    a contact of ours that is no crash, with its reason
  apart        the rectangles never touched: SUMO reports a pair whose gap is small but not nothing;
               the gap is listed
  unexplained  neither: the rectangles did overlap and we have no contact
Our crashes that SUMO lacks are counted by crash type. Exit status 1 when a collision of SUMO is
unexplained or a match is off in time."""
import collections
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

build, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
seconds = float(os.environ.get("AGREEMENT_SECONDS", "0"))
steps = [float(s) for s in os.environ.get("AGREEMENT_STEPS", "0.1 0.05").split()]
scenarios = source / "sumo_scenarios"
games = pathlib.Path("/usr/share/sumo/tools/game")
bologna = source.parent / "shared/reference/sumo_bologna_acosta"

# name: (configuration, driver errors, simulated seconds)
NETWORKS = {
    "left_turn": (scenarios / "left_turn/left_turn.sumocfg",
                  [("failed_to_see", "probability_1: 0.3")], 1800),
    "crossing": (scenarios / "crossing/crossing.sumocfg",
                 [("failed_to_see", "probability_1: 0.1"), ("misjudged_gap", "probability_1: 0.1"),
                  ("red_light", "probability_1: 0.05")], 1800),
    "head_on_overtaking": (scenarios / "head_on_overtaking/head_on_overtaking.sumocfg",
                           [("risky_overtaking", "probability_1: 0.5")], 1800),
    "bologna": (bologna / "run.sumocfg", [], 900),
    "bologna_errors": (bologna / "run.sumocfg",
                       [("failed_to_see", "probability_1: 0.1"),
                        ("misjudged_gap", "probability_1: 0.1")], 900),
    "game_cross": (games / "cross.sumocfg", [], 600),
    "game_square": (games / "square.sumocfg", [], 600),
    "game_ramp": (games / "ramp.sumocfg", [], 600),
    "game_grid6": (games / "grid6.sumocfg", [], 300),
}


def run(folder, name, step):
    """Database of one network at one step length; None when the network is not there."""
    configuration, errors, duration = NETWORKS[name]
    if not configuration.exists():
        return None
    # A copy: outputs that a configuration names are written beside it.
    copy = folder / configuration.parent.name
    if not copy.exists():
        shutil.copytree(configuration.parent, copy)
    models = "\n".join(f"      - model: {model}\n        parameters: {{{parameters}}}"
                       for model, parameters in errors)
    study = folder / f"{name}_{step}.yaml"
    study.write_text(
        f"study: {name}\ndesign: independent\nseed: 7\nreplications: 1\n"
        f"duration_s: {seconds or duration}\nstep_length_s: {step}\nscenarios:\n"
        f"  - name: {name}\n    sumocfg: {copy / configuration.name}\n"
        + (f"    driver_errors:\n{models}\n" if errors else "")
        + f"variants:\n  - name: baseline\nvehicles:\n"
        f"  default: {source / 'db/vehicles/mid_size.yaml'}\n")
    database = folder / f"{name}_{step}.db"
    subprocess.run([build / "crashpulse", "run", study, "--db", database, "--jobs", "1"],
                   check=True, stderr=subprocess.PIPE)
    return database


def compare(database, step):
    """Counts of one database and the lines about what does not agree."""
    db = sqlite3.connect(database)
    crashes = {}
    for time_s, kind, one, other in db.execute(
            "SELECT c.time_s, c.crash_type, a.sumo_id, b.sumo_id FROM crash c "
            "JOIN crash_vehicle a ON a.crash_id = c.id AND a.role = 'a' "
            "JOIN crash_vehicle b ON b.crash_id = c.id AND b.role = 'b'"):
        crashes[frozenset((one, other))] = (time_s, kind)
    counts, reasons, bad, apart, reported = collections.Counter(), collections.Counter(), [], [], set()
    for time_s, one, other, kind, found_as, gap_m in db.execute(
            "SELECT time_s, collider, victim, sumo_type, found_as, gap_m FROM sumo_collision"):
        pair = frozenset((one, other))
        reported.add(pair)
        counts["sumo"] += 1
        if pair in crashes:
            counts["matched"] += 1
            late = crashes[pair][0] - time_s
            # SUMO's time is the end of a step; ours lies inside one.
            if not -2 * step - 1e-9 <= late <= step + 1e-9:
                counts["off in time"] += 1
                bad.append(f"    {one} {other}: SUMO {time_s:.2f} s ({kind}), ours {late:+.2f} s")
        elif found_as == "no_contact" and gap_m is not None and gap_m > 0:
            counts["apart"] += 1
            apart.append(f"    {one} {other}: SUMO {time_s:.2f} s ({kind}), rectangles {gap_m:.3f} m apart")
        elif found_as == "no_contact":
            counts["unexplained"] += 1
            bad.append(f"    {one} {other}: SUMO {time_s:.2f} s ({kind}), no contact of ours")
        else:
            counts["explained"] += 1
            reasons[found_as] += 1
    ours = collections.Counter(kind for pair, (_, kind) in crashes.items() if pair not in reported)
    counts["ours"] = len(crashes)
    counts["ours only"] = sum(ours.values())
    for reason, number in db.execute("SELECT verdict, count(*) FROM contact GROUP BY 1"):
        reasons[f"contact {reason}"] = number
    return counts, reasons, ours, bad, apart


names = sys.argv[3:] or list(NETWORKS)
columns = ["sumo", "matched", "off in time", "explained", "apart", "unexplained", "ours", "ours only"]
print(f"{'network':20} {'step s':>6} " + " ".join(f"{c:>11}" for c in columns))
agrees = True
with tempfile.TemporaryDirectory() as folder:
    for name in names:
        for step in steps:
            database = run(pathlib.Path(folder), name, step)
            if database is None:
                print(f"{name:20} is not here: skipped")
                break
            counts, reasons, ours, bad, apart = compare(database, step)
            print(f"{name:20} {step:6g} " + " ".join(f"{counts[c]:11d}" for c in columns))
            for label, counter in (("reasons", reasons), ("ours only", ours)):
                if counter:
                    print(f"    {label}: " + ", ".join(f"{k} {v}" for k, v in sorted(counter.items())))
            print("\n".join(apart + bad), end="\n" if apart or bad else "", flush=True)
            agrees &= not bad
sys.exit(0 if agrees else 1)
