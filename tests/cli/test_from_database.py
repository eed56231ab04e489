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
parser.add_argument("--train", required=True, help="db/train_pulse_dictionary.py")
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

    # Models that pass each other: the words of the study, no numbers of an undisturbed motion.
    passing = folder / "passing.db"
    with sqlite3.connect(db) as whole, sqlite3.connect(passing) as copy:
        whole.backup(copy)
        copy.execute("UPDATE crash_vehicle SET cog_x_m = cog_x_m + 500, cog_y_m = cog_y_m + 300 WHERE "
                     "role = 'b' AND crash_id = ?", (crashes[0],))
        copy.execute("DELETE FROM pulse WHERE crash_id = ?", (crashes[0],))
    again = run(crashpulse, "crash", "--from", str(passing), "--crash", str(crashes[0]), "--format",
                "csv")
    assert "cannot be simulated: the outlines of the two vehicle models do not meet" in again.stderr
    for record in csv.DictReader(again.stdout.splitlines()):
        assert "no_contact" in record["validity"].split(","), record
        assert record["olc_status"] in ("simulation_failed", "not_front_contact"), record
        assert record["delta_v_km_h"] == "" and record["olc_g"] == "", record

    # A dictionary for a next codec, trained on these pulses: zstd's magic number, the number 1, 4 KB.
    dictionary = folder / "next.zdict"
    run(sys.executable, arguments.train, str(dictionary), str(db))
    content = dictionary.read_bytes()
    assert content[:8] == b"\x37\xa4\x30\xec\x01\0\0\0" and 500 < len(content) <= 4096, len(content)

    # One car a little heavier than it was: another pulse, said and told by the exit code.
    with sqlite3.connect(db) as tampered:
        tampered.execute("UPDATE vehicle_model SET yaml = replace(yaml, '1500', '1501')")
    again = run(crashpulse, "crash", "--from", str(db), "--crash", str(crashes[0]), expect=1)
    assert "not the stored ones" in again.stderr, again.stderr
    assert "hashes of vehicle files" in run(crashpulse, "check", str(db), expect=1).stdout
    # What crashes became under a treatment, too.
    inputs.mkdir()
    shutil.copytree(arguments.network, inputs / "net")
    (inputs / "study.yaml").write_text(
        STUDY.replace("paired_seeds", "counterfactual").replace(
            "function: aeb}", "function: aeb, parameters: {ttc_s: 0.7, deceleration_m_s2: 5}}"))
    (inputs / "car.yaml").write_text("vehicle: car\nparameters:\n  - {name: mass_kg, value: 1500}\n")
    (inputs / "van.yaml").write_text("vehicle: van\nparameters:\n  - {name: mass_kg, value: 2100}\n")
    pairs = folder / "pairs.db"
    run(crashpulse, "run", str(inputs / "study.yaml"), "--db", str(pairs), "--jobs", "2")
    shutil.rmtree(inputs)
    checked = {row["what"]: row for row in csv.DictReader(
        run(crashpulse, "check", str(pairs), "--format", "csv").stdout.splitlines())}
    connection = sqlite3.connect(pairs)
    treated = connection.execute("SELECT c.crash_id, v.name, c.time_s FROM counterfactual AS c JOIN "
                                 "variant AS v ON v.id = c.variant_id").fetchall()
    pulses = connection.execute("SELECT count(*) FROM counterfactual_pulse").fetchone()[0]
    assert int(checked["stored pulses of treated vehicles"]["looked_at"]) == pulses > 0, checked
    crashed = [(crash, variant) for crash, variant, time_s in treated if time_s is not None]
    assert len(crashed) >= 2, treated
    for crash, variant in crashed:
        again = run(crashpulse, "crash", "--from", str(pairs), "--crash", str(crash), "--treatment",
                    variant, "--format", "csv")
        assert "byte for byte" in again.stderr and f"under {variant}" in again.stderr, again.stderr
        for record in csv.DictReader(again.stdout.splitlines()):
            stored = connection.execute(
                "SELECT olc_g, olc_status, validity FROM counterfactual_vehicle WHERE crash_id = ? "
                "AND role = ?", (crash, record["role"])).fetchone()
            printed = float(record["olc_g"]) if record["olc_g"] else None
            assert (printed, record["olc_status"], record["validity"]) == stored, (record, stored)
    others = [crash for crash, _, time_s in treated if time_s is None]
    for crash in others[:1]:
        result = run(crashpulse, "crash", "--from", str(pairs), "--crash", str(crash), "--treatment",
                     "aeb", expect=2)
        assert "became no crash under aeb" in result.stderr, result.stderr
    # Damage in them is found.
    with connection:
        connection.execute("UPDATE counterfactual_pulse SET samples = substr(samples, 1, 40) WHERE "
                           "role = 'b' AND crash_id = ?", (crashed[0][0],))
    assert f"vehicle b of crash {crashed[0][0]} under variant" in run(
        crashpulse, "check", str(pairs), expect=1).stdout
    print(f"{len(crashed)} treated crashes and {len(crashes)} crashes simulated again from the database alone")
