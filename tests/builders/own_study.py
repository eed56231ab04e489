# SPDX-License-Identifier: GPL-3.0-or-later
"""A study of the crossing of tests/run with functions of one's own: written, run, and what came of it."""
import shutil
import sqlite3

import crossing_study

STUDY = """study: own
design: {design}
seed: 5
replications: {replications}
duration_s: {duration_s}
scenarios:
  - name: crossing
    sumocfg: net/crossing.sumocfg
    driver_errors:
      - {{model: failed_to_see, parameters: {{probability_1: 1}}}}
variants:
  - name: baseline
{variants}
background: {{duration_s: 0}}
vehicles: {{default: car.yaml}}
"""


def study_in(folder, network, variants, design="paired_seeds", replications=2, duration_s=40):
    """variants: {name: [text of each function]}."""
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "net").exists():
        shutil.copytree(network, folder / "net")
    (folder / "car.yaml").write_text("vehicle: car\nparameters: []\n")
    text = "".join(f"  - name: {name}\n    functions:\n" +
                   "".join(f"      - {function}\n" for function in functions)
                   for name, functions in variants.items())
    study = folder / "study.yaml"
    study.write_text(STUDY.format(design=design, replications=replications, duration_s=duration_s,
                                  variants=text))
    return study


def run(crashpulse, study, db, *words, expect=0):
    return crossing_study.run(crashpulse, "run", study, "--db", db, "--allow-plugins",
                              *words, expect=expect)


def messages(db):
    """{variant: [messages of its failed attempts]}, and the variants that are done."""
    failed, done = {}, set()
    for name, status, text in sqlite3.connect(db).execute(
            "SELECT v.name, r.status, a.message FROM replication r JOIN variant v ON v.id = r.variant_id"
            " JOIN attempt a ON a.replication_id = r.id"):
        if status == "failed":
            failed.setdefault(name, []).append(text)
        else:
            done.add(name)
    return failed, done


def rows(db):
    """As crossing_study.rows, less what names files and their hashes."""
    connection = sqlite3.connect(db)
    found = {}
    for (table,) in connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name "
                                       "NOT LIKE 'sqlite_%'").fetchall():
        columns = [c[1] for c in connection.execute(f"PRAGMA table_info({table})")]
        kept = [c for c in columns if (table, c) not in {
            ("study", "yaml"), ("study", "hash"), ("variant", "functions"),
            ("replication", "configuration_hash"), ("background_run", "configuration_hash")}]
        if table not in ("attempt", "merge_source"):
            names = ", ".join(f'"{c}"' for c in kept)
            found[table] = sorted(connection.execute(f"SELECT {names} FROM {table}").fetchall(), key=repr)
    return found


def assert_same(db, other):
    one, two = rows(db), rows(other)
    assert one.keys() == two.keys()
    for table in one:
        assert one[table] == two[table], (table, [r for r in one[table] if r not in two[table]][:2],
                                          [r for r in two[table] if r not in one[table]][:2])
    assert len(one["crash"]) > 0, "nothing to compare"
