# SPDX-License-Identifier: GPL-3.0-or-later
"""A study's networks without driver errors: run once each beside the replications, stored contact by
contact, the same again after a restart, told by run, status, compare and the report, left out when the
study says so; and what fails there fails the run, not the replications."""
import argparse
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--worker", required=True)
parser.add_argument("--network", required=True)
arguments = parser.parse_args()

SWEEP = """sweep:
  - {parameter: scenarios.crossing.failed_to_see.probability_1, values: [0.5, 1]}
  - {parameter: scenarios.crossing.sumo_options.scale, values: [0.5, 1]}
"""
CARELESS = ('<vType ', '<vType jmIgnoreFoeProb="1" jmIgnoreFoeSpeed="100" jmIgnoreJunctionFoeProb="1" ')


def run(*words, expect=0):
    return crossing_study.run(arguments.crashpulse, *words, expect=expect)


def query(db, sql):
    connection = sqlite3.connect(db)
    rows = connection.execute(sql).fetchall()
    connection.close()
    return rows


def careful(folder):
    # One for each value of the option of SUMO, shared by the values of the error.
    study, db = crossing_study.write(folder, arguments.network, 1, 10, more=SWEEP), folder / "careful.db"
    assert "and 2 of 10 s without driver errors" in run("plan", study).stdout
    result = run("run", study, "--db", db)
    assert "warning" not in result.stderr, result.stderr
    rows = query(db, "SELECT s.name, b.simulated_s, b.vehicle_km > 0.1, b.vehicle_h > 0, b.departed > 0, "
                     "length(b.configuration_hash), b.seed = r.seed FROM background_run AS b JOIN scenario "
                     "AS s ON s.id = b.scenario_id JOIN replication AS r ON r.scenario_id = s.id JOIN "
                     "variant AS v ON v.id = r.variant_id AND v.is_baseline ORDER BY s.number")
    assert rows == [(f"crossing@probability_1=0.5@scale={scale}", 10.0, 1, 1, 1, 64, 1)
                    for scale in ("0.5", "1")], rows
    rows = query(db, "SELECT runs, crashes, is_negligible FROM background_by_scenario")
    assert len(rows) == 4 and all(row == (1, 0, 1) for row in rows), rows

    # Nothing is left to do; what is lost is made again, to the bit.
    before = crossing_study.rows(db)
    run("run", study, "--db", db)
    assert crossing_study.rows(db) == before
    connection = sqlite3.connect(db)
    connection.execute("DELETE FROM background_contact")
    connection.execute("DELETE FROM background_run")
    connection.commit()
    connection.close()
    assert "0 done now" in run("run", study, "--db", db).stderr
    assert crossing_study.rows(db) == before

    # A study that has none says so, and keeps what was there.
    text = study.read_text()
    study.write_text(text + "background: {duration_s: 0}\n")
    assert "without driver errors" not in run("plan", study).stdout
    run("run", study, "--db", db)
    assert len(query(db, "SELECT * FROM background_run")) == 2
    run("run", study, "--db", folder / "none.db")
    assert "no background was simulated" in run("compare", folder / "none.db", "--no-store").stdout.replace(
        "\n", " ")
    # Another length replaces it.
    study.write_text(text + "background: {duration_s: 15}\n")
    run("run", study, "--db", db)
    assert query(db, "SELECT simulated_s FROM background_run") == [(15.0,)] * 2

    # What the command finds is what the study found.
    run("background", study, "--db", db)
    rows = query(db, "SELECT simulated_s, configuration_hash <> '' FROM background_run")
    assert len(rows) == 4 and all(row == (15.0, 1) for row in rows), rows
    result = subprocess.run([arguments.worker, "--background", "--study", study, "--scenario",
                             "crossing@probability_1=1@scale=1", "--db", db, "--expect", "00"],
                            capture_output=True, text=True)
    assert result.returncode == 2 and "was changed during the run" in result.stderr, result


def careless(folder):
    # Drivers that look at nothing by SUMO's own knob: the network's crashes, in everybody's words.
    study, db = crossing_study.write(folder, arguments.network, 1, 60), folder / "careless.db"
    routes = folder / "net/crossing.rou.xml"
    routes.write_text(routes.read_text().replace(*CARELESS))
    result = run("run", study, "--db", db)
    (expected, baseline, crashes, negligible), = query(
        db, "SELECT expected_crashes, baseline_crashes, crashes, is_negligible FROM background_by_scenario")
    assert crashes > 0 and negligible == 0 and expected > 0.05 * baseline, (expected, baseline, crashes)
    words = "are the network's doing, not the drivers'"
    assert "warning: in crossing some" in result.stderr and words in result.stderr, result.stderr
    assert words in run("status", db).stdout
    assert words in run("compare", db, "--no-store").stdout.replace("\n", " ")
    background, = json.loads(run("compare", db, "--no-store", "--format", "json").stdout)["background"]
    assert background["is_known"] and not background["is_negligible"] and words in background["warning"]
    assert background["text"].startswith(f"{crashes} crash"), background
    run("report", db, "--output", folder / "report.html")
    assert "the network's doing, not the drivers'" in (folder / "report.html").read_text()
    # What lies where it crashes by itself, with and without; and it can be left out.
    (at_sites, all_of_them), = query(db, "SELECT crashes_at_flagged, crashes FROM flagged_sites WHERE "
                                         "is_baseline")
    assert 0 < at_sites <= all_of_them == baseline
    sentence = ("in crossing there lie within 20 m of where the network crashes without driver errors "
                f"{at_sites} of the {baseline} crashes of baseline")
    assert sentence in result.stderr and sentence in run("status", db).stdout
    assert any(sentence in text for text in json.loads(
        run("compare", db, "--no-store", "--format", "json").stdout)["caveats"])
    assert sentence in (folder / "report.html").read_text()
    figures = json.loads(run("compare", db, "--no-store", "--format", "json", "--where",
                             "at_flagged_site = 0").stdout)["variants"]
    assert figures[0]["crashes"] == baseline - at_sites, figures
    # An error that never acted, as the counters have it.
    connection = sqlite3.connect(db)
    connection.execute("UPDATE replication SET counters = '{\"failed_to_see.overlooked_pairs\": 0.0}'")
    connection.commit()
    connection.close()
    assert "in crossing the driver error failed_to_see never acted in" in run("status", db).stdout
    # Every crash of it with its place, cars and speed.
    rows = query(db, "SELECT count(*), count(time_s + x_m + y_m + closing_speed_m_s), count(crash_type || "
                     "vehicle_1 || vehicle_2), min(closing_speed_m_s) > 0 FROM background_contact WHERE "
                     "reason = 'crash' AND crash_type <> ''")
    assert rows == [(crashes, crashes, crashes, 1)], rows


def short(folder):
    # Demand for some seconds of many, over three seeds: told, each with traffic of its own.
    study, db = crossing_study.write(folder, arguments.network, 3, 4000), folder / "short.db"
    routes = folder / "net/crossing.rou.xml"
    vehicle = '<vehicle id="{}" type="car" depart="{}"><route edges="west_in east_out"/></vehicle>'
    routes.write_text('<routes><vType id="car"/><vType id="van"/>' + "".join(vehicle.format(k, 2 * k) for k in range(9)) +
                      "</routes>")
    result = run("run", study, "--db", db)
    assert "in crossing the traffic of 6 replications was over before duration_s, " in result.stderr
    assert "3 a network" in run("plan", study).stdout
    seeds = [row[0] for row in query(db, "SELECT seed FROM background_run ORDER BY 1")]
    assert seeds == [row[0] for row in query(db, "SELECT DISTINCT seed FROM replication ORDER BY 1")]


def without_occasion(folder):
    # Errors that a network gives no occasion for are told before anything is run.
    study = crossing_study.write(folder, arguments.network, 1, 10)
    study.write_text(study.read_text().replace(
        "    driver_errors:\n", "    driver_errors:\n      - {model: red_light}\n"
        "      - {model: risky_overtaking}\n"))
    told = run("plan", study).stderr
    assert "scenario crossing: risky_overtaking cannot act: no lane of the network may overtake" in told, told
    lights = "tlLogic" in (folder / "net/crossing.net.xml").read_text()
    assert ("red_light cannot act: the network has no traffic light" in told) != lights, told
    net = folder / "net/crossing.net.xml"
    net.write_text(net.read_text().replace("</net>", '<tlLogic id="t"/><!-- no <neigh lane="x"/> --></net>'))
    told = run("plan", study).stderr
    assert "red_light cannot act" not in told and "risky_overtaking cannot act" in told, told


def failing(folder):
    # A vehicle on an edge that is not there, which SUMO reads when the replications are over.
    study, db = crossing_study.write(folder, arguments.network, 1, 20,
                                     more="background: {duration_s: 600}\n"), folder / "failing.db"
    routes = folder / "net/crossing.rou.xml"
    good = routes.read_text()
    vehicle = '<vehicle id="{}" type="car" depart="{}"><route edges="{}"/></vehicle>'
    routes.write_text(good.replace("</routes>", vehicle.format("late", 540, "west_in east_out") +
                                   vehicle.format("lost", 550, "nowhere") + "</routes>"))
    for _ in range(2):
        result = run("run", study, "--db", db, expect=1)
        assert "1 of the networks' backgrounds failed" in result.stderr, result.stderr
        assert "background of scenario crossing" in result.stderr and "nowhere" in result.stderr, result.stderr
        assert query(db, "SELECT status, count(*) FROM replication GROUP BY 1") == [("done", 2)]
        assert query(db, "SELECT count(*) FROM background_run") == [(0,)]
    # A replication that failed is missing, and not at random.
    connection = sqlite3.connect(db)
    connection.execute("UPDATE replication SET status = 'failed' WHERE variant_id = (SELECT variant_id "
                       "FROM replication LIMIT 1)")
    connection.commit()
    connection.close()
    assert "failed and are in no figure: what SUMO ended itself is not missing at random" in run(
        "status", db).stdout


with tempfile.TemporaryDirectory() as name:
    for case in (careful, careless, short, without_occasion, failing):
        folder = pathlib.Path(name) / case.__name__
        folder.mkdir()
        case(folder)
        print(f"{case.__name__}: good", flush=True)
