# SPDX-License-Identifier: GPL-3.0-or-later
"""A study with sweeps from plan to SQL: what is planned is run, a sweep that grows adds what is new,
what contradicts rows already done is refused with the difference, and the values are there to join."""
import argparse
import json
import pathlib
import sqlite3
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True)
arguments = parser.parse_args()

SWEEP = """sweep:
  - {{parameter: variants.aeb.ttc_s, values: [{ttc}]}}
  - {{parameter: scenarios.crossing.failed_to_see.probability_1, from: 0.5, to: 1, steps: 2}}
  - {{parameter: scenarios.crossing.sumo_options.scale, values: [1]}}
"""


def run(*words, expect=0):
    return crossing_study.run(arguments.crashpulse, *words, expect=expect)


def write(folder, ttc, duration_s=20):
    return crossing_study.write(folder, arguments.network, 1, duration_s, more=SWEEP.format(ttc=ttc))


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    db = folder / "study.db"
    study = write(folder, "0.8, 1.6")

    # Two scenarios with three variants each; every swept value is told.
    plan = json.loads(run("plan", study, "--format", "json").stdout)
    assert [(p["scenario"], p["variant"], p["replications"]) for p in plan] == [
        (f"crossing@probability_1={p}@scale=1", v, 1) for p in ("0.5", "1")
        for v in ("baseline", "aeb@ttc_s=0.8", "aeb@ttc_s=1.6")], plan
    assert plan[2]["swept"] == {"variants.aeb.aeb.ttc_s": 1.6,
                                "scenarios.crossing.failed_to_see.probability_1": 0.5,
                                "scenarios.crossing.sumo_options.scale": 1}, plan[2]
    assert not db.exists()
    run("run", study, "--db", db)
    run("check", db)

    # The values in SQL.
    connection = sqlite3.connect(db)
    assert connection.execute(
        "SELECT DISTINCT value FROM variant_parameter WHERE base = 'aeb' AND parameter = 'ttc_s' AND "
        "swept ORDER BY 1").fetchall() == [(0.8,), (1.6,)]
    assert connection.execute("SELECT count(*) > 5, sum(swept) FROM variant_parameter WHERE variant "
                              "= 'aeb@ttc_s=0.8'").fetchone() == (1, 1)
    assert connection.execute(
        "SELECT driver_error, parameter, value, swept FROM scenario_parameter WHERE scenario = "
        "'crossing@probability_1=0.5@scale=1' ORDER BY 1").fetchall() == [
            ("failed_to_see", "probability_1", 0.5, 1), ("sumo_options", "scale", 1.0, 1)]
    curve = connection.execute(
        "SELECT p.value, o.crashes FROM olc_by_variant AS o JOIN variant_parameter AS p USING "
        "(variant_id) WHERE p.base = 'aeb' AND p.parameter = 'ttc_s' ORDER BY 1").fetchall()
    assert [value for value, _ in curve] == [0.8, 1.6], curve
    done = connection.execute("SELECT id, vehicle_km FROM replication ORDER BY id").fetchall()
    connection.close()

    # A value more adds its replications, and leaves those done alone.
    study = write(folder, "0.8, 1.2, 1.6")
    plan = json.loads(run("plan", study, "--db", db, "--format", "json").stdout)
    assert sum(p["done"] for p in plan) == 6 and sum(p["new"] for p in plan) == 2, plan
    assert "8 replications of 20 s" in run("plan", study, "--db", db).stdout
    each = json.loads(run("plan", study, "--db", db, "--each", "--format", "json").stdout)
    assert [e["state"] for e in each].count("done") == 6 and len({e["seed"] for e in each}) == 1
    result = run("run", study, "--db", db)
    assert "8 replications: 6 done before, 2 done now" in result.stderr, result.stderr
    connection = sqlite3.connect(db)
    after = dict(connection.execute("SELECT id, vehicle_km FROM replication").fetchall())
    assert len(after) == 8 and all(after[id_] == km for id_, km in done)
    connection.close()

    # A value less, or another duration, contradicts; plan says so as run does, and nothing changes.
    before = crossing_study.rows(db)
    for ttc, duration_s, says in (
            ("0.8, 1.2", 20, "the study file plans it no more"),
            ("0.8, 1.2, 1.6", 30, "duration_s was '20.0', is now '30.0'")):
        changed = write(folder, ttc, duration_s)
        for command in ("plan", "run"):
            result = run(command, changed, "--db", db, expect=2)
            assert says in result.stderr, result.stderr
    assert crossing_study.rows(db) == before
