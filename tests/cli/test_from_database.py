# SPDX-License-Identifier: GPL-3.0-or-later
"""A study is run, everything but its database is thrown away, and every crash in it is simulated
again: after the codec the stored bytes. A database that was tampered with is noticed."""
import argparse
import csv
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

STUDY = """study: again
design: paired_seeds
seed: 5
replications: 1
duration_s: 40
scenarios:
  - name: crossing
    sumocfg: net/crossing.sumocfg
    driver_errors:
      - {model: failed_to_see, parameters: {probability_1: 1}}
variants:
  - name: baseline
  - {name: aeb, functions: [{function: aeb}]}
vehicles:
  default: car.yaml
  types: [{type: van, model: van.yaml}]
"""


def run(*words, expect=0):
    result = subprocess.run(words, capture_output=True, text=True)
    if result.returncode != expect:
        sys.exit(f"{' '.join(words)}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result


parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True, help="folder of the crossing")
arguments = parser.parse_args()
crashpulse = arguments.crashpulse

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    inputs = folder / "inputs"
    inputs.mkdir()
    shutil.copytree(arguments.network, inputs / "net")
    (inputs / "study.yaml").write_text(STUDY)
    (inputs / "car.yaml").write_text("vehicle: car\nparameters:\n  - {name: mass_kg, value: 1500}\n")
    (inputs / "van.yaml").write_text("vehicle: van\nparameters:\n  - {name: mass_kg, value: 2100}\n")
    db = folder / "study.db"
    run(crashpulse, "run", str(inputs / "study.yaml"), "--db", str(db), "--jobs", "2")
    shutil.rmtree(inputs)

    found = list(csv.DictReader(
        run(crashpulse, "check", str(db), "--format", "csv").stdout.splitlines()))
    assert len(found) > 8 and all(row["wrong"] == "0" for row in found), found
    crashes = [row[0] for row in sqlite3.connect(db).execute("SELECT id FROM crash ORDER BY id")]
    assert len(crashes) >= 5, crashes
    for crash in crashes:
        again = run(crashpulse, "crash", "--from", str(db), "--crash", str(crash), "--format", "csv")
        assert "byte for byte" in again.stderr, again.stderr
        # The printed OLC is the stored one, to the last digit.
        for record in csv.DictReader(again.stdout.splitlines()):
            stored = sqlite3.connect(db).execute(
                "SELECT olc_g, olc_status, validity FROM crash_vehicle WHERE crash_id = ? AND "
                "role = ?", (crash, record["role"])).fetchone()
            printed = float(record["olc_g"]) if record["olc_g"] else None
            assert (printed, record["olc_status"], record["validity"]) == stored, (record, stored)

    page, pulse = folder / "again.html", folder / "again.csv"
    run(crashpulse, "crash", "--from", str(db), "--crash", str(crashes[0]), "--animate", str(page),
        "--pulse", str(pulse), "--raw")
    assert page.stat().st_size > 10000 and len(pulse.read_text().splitlines()) > 400

    # One car a little heavier than it was: another pulse, said and told by the exit code.
    with sqlite3.connect(db) as tampered:
        tampered.execute("UPDATE vehicle_model SET yaml = replace(yaml, '1500', '1501')")
    again = run(crashpulse, "crash", "--from", str(db), "--crash", str(crashes[0]), expect=1)
    assert "not the stored ones" in again.stderr, again.stderr
    assert "hashes of vehicle files" in run(crashpulse, "check", str(db), expect=1).stdout
    print(f"{len(crashes)} crashes simulated again from the database alone")
