# SPDX-License-Identifier: GPL-3.0-or-later
"""The study that tests of whole runs share: the crossing of tests/run with real SUMO, seconds a
replication, and what its database holds apart from who worked on it when."""
import pathlib
import shutil
import sqlite3
import subprocess

STUDY = """study: crossing
design: paired_seeds
seed: {seed}
replications: {replications}
duration_s: {duration_s}
scenarios:
  - name: crossing
    sumocfg: net/crossing.sumocfg
    driver_errors:
      - {{model: failed_to_see, parameters: {{probability_1: 1}}}}
variants:
  - name: baseline
  - {{name: aeb, functions: [{{function: aeb}}]}}
vehicles:
  default: car.yaml
  types: [{{type: van, model: car.yaml}}]
{more}"""


def write(folder, network, replications, duration_s=40, seed=5, more=""):
    """Study file in folder, which gets the network and a car too."""
    folder = pathlib.Path(folder)
    if not (folder / "net").exists():
        shutil.copytree(network, folder / "net")
    (folder / "car.yaml").write_text("vehicle: car\nparameters: []\n")
    study = folder / "study.yaml"
    study.write_text(STUDY.format(replications=replications, duration_s=duration_s, seed=seed,
                                  more=more))
    return study


def run(crashpulse, *words, expect=0, environment=None):
    result = subprocess.run([crashpulse, *map(str, words)], capture_output=True, text=True,
                            env=environment)
    if expect is not None and result.returncode != expect:
        raise AssertionError(f"{' '.join(map(str, words))}: exit code {result.returncode}\n"
                             f"{result.stdout}{result.stderr}")
    return result


def rows(db):
    """All rows of all tables but attempt and merge_source, in order."""
    connection = sqlite3.connect(db, timeout=60)
    found = {}
    tables = connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT "
                                "LIKE 'sqlite_%' ORDER BY name").fetchall()
    for (table,) in tables:
        if table not in ("attempt", "merge_source"):
            found[table] = sorted(connection.execute(f"SELECT * FROM {table}").fetchall(), key=repr)
    connection.close()
    return found


def assert_same(db, other):
    one, two = rows(db), rows(other)
    assert one.keys() == two.keys(), (one.keys(), two.keys())
    for table in one:
        if one[table] != two[table]:
            only = [row for row in one[table] if row not in two[table]][:3]
            raise AssertionError(f"{table}: {len(one[table])} rows in {db}, {len(two[table])} in "
                                 f"{other}; only in the first: {only}")
    assert len(one["crash"]) > 0 and len(one["pulse"]) > 0
