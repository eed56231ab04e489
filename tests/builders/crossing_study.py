# SPDX-License-Identifier: GPL-3.0-or-later
"""The study that tests of whole runs share: the crossing of tests/run with real SUMO, seconds a
replication, and whether databases hold the same apart from who worked on it when."""
import pathlib
import shutil
import subprocess

import compare_databases

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
    """{table: its sorted rows}, apart from who made them when (compare_databases.py)."""
    return {table: found for table, (_, found) in compare_databases.read(db).items()}


def assert_same(db, other):
    lines = compare_databases.differences(db, other)
    assert not lines, "\n".join(lines)
    held = rows(db)
    assert held["crash"] and held["pulse"], f"{db} holds no crash"
