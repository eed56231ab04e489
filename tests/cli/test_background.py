# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse background: what contacts a network makes without driver errors. Of a crossing whose
drivers ignore each other by SUMO's own knob there remain crashes, of the crossing as it is none; of a
study its driver errors are left out and the result is stored in its database, once."""
import argparse
import csv
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True, help="folder of the crossing")
arguments = parser.parse_args()

STUDY = """study: crossing
design: independent
seed: 5
replications: 1
duration_s: 60
scenarios:
  - name: crossing
    sumocfg: net/crossing.sumocfg
    driver_errors:
      - {model: failed_to_see, parameters: {probability_1: 1}}
variants:
  - name: baseline
vehicles:
  default: mid_size
"""


def run(*words, expect=0):
    result = subprocess.run([arguments.crashpulse, *map(str, words)], capture_output=True, text=True)
    if result.returncode != expect:
        sys.exit(f"{words}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result


def background(*words):
    return list(csv.DictReader(run("background", *words, "--format", "csv").stdout.splitlines()))


def crashes(rows):
    return sum(int(row["contacts"]) for row in rows
               if row["reported_by"] == "ours" and row["reason"] == "crash")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    shutil.copytree(arguments.network, folder / "net")
    configuration = folder / "net/crossing.sumocfg"
    calm = background(configuration, "--duration", "60", "--step-length", "0.05", "--seed", "3")
    assert crashes(calm) == 0 and float(calm[0]["simulated_s"]) == 60.0, calm
    assert float(calm[0]["vehicle_km"]) > 1.0 and calm[0]["network"] == str(configuration), calm

    # The same network with drivers who do not look: its crashes are told by type, SUMO's own reports
    # of them by what became of them.
    routes = folder / "net/crossing.rou.xml"
    text = routes.read_text()
    careless = text.replace("<vType ", '<vType jmIgnoreFoeProb="1" jmIgnoreFoeSpeed="100" '
                            'jmIgnoreJunctionFoeProb="1" ')
    assert careless != text
    routes.write_text(careless)
    wild = background(configuration, "--duration", "60", "--step-length", "0.05", "--seed", "3")
    assert crashes(wild) > 0, wild
    assert all(row["crash_type"] for row in wild if row["reason"] == "crash" and
               row["reported_by"] == "ours"), wild
    assert any(row["reported_by"] == "SUMO" and row["reason"] == "crash" for row in wild), wild
    routes.write_text(text)

    # A study: without its errors, at its duration and step; a second time replaces the first.
    study, database = folder / "study.yaml", folder / "study.db"
    study.write_text(STUDY)
    message = run("background", study, "--db", database, expect=2).stderr
    assert "study.db" in message, message
    run("run", study, "--db", database)
    own = sqlite3.connect(database).execute("SELECT * FROM background_run").fetchall()
    assert sqlite3.connect(database).execute("SELECT count(*) FROM crash").fetchone()[0] > 0
    for _ in range(2):
        rows = background(study, "--db", database)
        assert crashes(rows) == 0 and rows[0]["network"] == "crossing", rows
        stored = sqlite3.connect(database).execute(
            "SELECT s.name, b.simulated_s, b.step_length_s FROM background_run AS b JOIN scenario AS s "
            "ON s.id = b.scenario_id").fetchall()
        assert stored == [("crossing", 60.0, 0.05)], stored
        contacts = dict(sqlite3.connect(database).execute("SELECT reason, contacts FROM background_by_reason"))
        assert contacts == {row["reason"]: int(row["contacts"]) for row in rows
                            if row["reported_by"] == "ours" and int(row["contacts"])}, (contacts, rows)
        # It is the run that the study made.
        assert sqlite3.connect(database).execute("SELECT * FROM background_run").fetchall() == own

    # Of another seed: beside it.
    background(study, "--db", database, "--seed", "3")
    assert sqlite3.connect(database).execute(
        "SELECT count(*), sum(configuration_hash = '') FROM background_run").fetchone() == (2, 1)

    # What is wrong.
    message = run("background", folder / "none.sumocfg", expect=2).stderr
    assert "none.sumocfg" in message, message
    message = run("background", configuration, "--db", database, expect=2).stderr
    assert "--db is for the scenarios of a study" in message, message
    state = folder / "net/state.sumocfg"
    state.write_text(configuration.read_text().replace("<input>", '<input><load-state value="s.xml"/>'))
    message = run("background", state, expect=2).stderr
    assert "state.sumocfg:4: load-state must not be set, found 's.xml'" in message, message
