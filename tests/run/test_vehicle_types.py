# SPDX-License-Identifier: GPL-3.0-or-later
"""Real SUMO traffic of mixed vehicle types: which model each crashes as, and that what has none is
named and not made a car."""
import argparse
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
from crossing_study import run  # noqa: E402

# type: attributes, parameters, then model and rule expected (None: has no model)
TYPES = {
    "plain": ('length="5" width="1.8"', "", "honda_accord_2014", "class_and_size"),
    "little": ('length="3.9" width="1.72"', "", "small_car", "class_and_size"),
    "parcels": ('vClass="delivery"', "", "van", "class_and_size"),
    "named": ('length="4.5" width="1.8"', '<param key="crashpulse.model" value="suv"/>', "suv",
              "sumo_type"),
    "own_file": ('length="4.5" width="1.8"',
                 "<param value='../cars/mine.yaml' key='crashpulse.model'/>", "mine", "sumo_type"),
    "mapped": ('length="4.5" width="1.8"', '<param key="crashpulse.model" value="suv"/>',
               "toyota_camry_2018", "study"),
    "heavy": ('length="4.9" width="1.9"', '<param key="vehicleMass" value="2900"/>', None,
              "no shipped model of vClass passenger is 4.9 m long, 1.9 m wide, 1.5 m high, 2900 kg"),
    "lorry": ('vClass="truck"', "", "rigid_truck", "class_and_size"),
    "rider": ('vClass="motorcycle"', "", None, "no shipped model of vClass motorcycle"),
    "coach_as_car": ('length="13" width="2.5"', "", None,
                     "no shipped model of vClass passenger is 13 m long, 2.5 m wide, 1.5 m high"),
}
STUDY = """study: types
design: {design}
seed: 5
replications: 1
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
{default}  types: [{{type: mapped, model: toyota_camry_2018}}]
"""
FLOWS = [("through", 0, 3.1, "west_in", "east_out"), ("left", 0.4, 4.3, "east_in", "south_out")]
VEHICLE = "vehicle: mine\nparameters:\n  - {name: mass_kg, value: 1500}\n"

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True, help="folder of the crossing")
parser.add_argument("--town", required=True, help="route file of the town")
arguments = parser.parse_args()
crashpulse = arguments.crashpulse


def write_routes(path, types):
    vtypes = "".join(f'<vType id="{name}" sigma="0.5" probability="1" {attributes}>{inside}</vType>'
                     for name, (attributes, inside, _, _) in types.items())
    flows = "".join(
        f'<flow id="{name}" type="mixed" begin="{begin}" end="400" period="{period}" from="{start}" '
        f'to="{end}" departSpeed="desired"/>' for name, begin, period, start, end in FLOWS)
    path.write_text(f'<routes><vTypeDistribution id="mixed">{vtypes}</vTypeDistribution>'
                    f"<!-- <param key=\"crashpulse.model\" value=\"nothing\"/> -->{flows}</routes>")


def check(condition, *words):
    if not condition:
        sys.exit(" ".join(map(str, words)))


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    shutil.copytree(arguments.network, folder / "net")
    (folder / "cars").mkdir()
    (folder / "cars" / "mine.yaml").write_text(VEHICLE)
    study, db = folder / "study.yaml", folder / "study.db"
    routes = folder / "net" / "crossing.rou.xml"
    write_routes(routes, TYPES)
    study.write_text(STUDY.format(design="counterfactual", duration_s=320, default=""))
    result = run(crashpulse, "run", study, "--db", db)
    connection = sqlite3.connect(db)

    # Every type that crashed did so as it should, and says by which rule.
    seen = {row[0]: row[1:] for row in connection.execute(
        "SELECT sumo_type, vehicle_model, chosen_by, reason FROM vehicle_type_model")}
    check(set(seen) == set(TYPES), "types that crashed:", sorted(seen))
    for sumo_type, (model, chosen_by, reason) in seen.items():
        _, _, expected, rule = TYPES[sumo_type]
        check((model, chosen_by if model else reason) == (expected, rule), sumo_type, model,
              chosen_by, reason)
        check(expected or f"vehicle type {sumo_type} are kept without a severity: {rule}"
              in result.stderr, "nothing was said of", sumo_type, result.stderr)
    for table in "crash_vehicle", "counterfactual_vehicle":
        wrong = [row for row in connection.execute(
            f"SELECT sumo_type, vehicle_model, validity, olc_status FROM {table}")
            if row[1] != (TYPES[row[0]][2] or "none")
            or ("no_model" in row[2].split(",")) != (row[1] == "none")]
        check(not wrong, table, wrong[:3])

    # A crash with one of them has no severity, and no crash is inside; others are simulated.
    none = [row[0] for row in connection.execute(
        "SELECT crash_id FROM crash_vehicle WHERE vehicle_model = 'none'")]
    bad = connection.execute(
        "SELECT count(*) FROM crash_vehicle AS v JOIN crash AS c ON c.id = v.crash_id WHERE "
        "(c.validity LIKE '%no_model%') <> (v.delta_v_m_s IS NULL) OR (c.validity LIKE '%no_model%') "
        "<> NOT EXISTS (SELECT 1 FROM pulse AS p WHERE p.crash_id = c.id)").fetchone()[0]
    check(none and bad == 0, len(none), "crashes without a model,", bad, "contradictions")
    status = connection.execute("SELECT status, count(*) FROM null_treatment GROUP BY 1").fetchall()
    check(all(s in ("reproduced", "inserted_late", "no_checkpoint") for s, _ in status), status)

    # Simulated again from the database alone: the bytes; without a model it says so.
    crashes = [row[0] for row in connection.execute("SELECT id FROM crash ORDER BY id")]
    check(len(crashes) > len(set(none)), "no crash of two cars with models")
    for crash in crashes:
        again = subprocess.run([crashpulse, "crash", "--from", db, "--crash", str(crash)],
                               capture_output=True, text=True)
        if crash in none:
            check(again.returncode == 2 and "has no model" in again.stderr, again.stderr)
        else:
            check(again.returncode == 0 and "byte for byte" in again.stderr, again.stderr)
    check(run(crashpulse, "check", db).returncode == 0)
    connection.close()

    # The study's default is for cars of a car's size; vans and the rest are not made one.
    study.write_text(STUDY.format(design="paired_seeds", duration_s=100,
                                  default="  default: cars/mine.yaml\n"))
    run(crashpulse, "run", study, "--db", folder / "default.db")
    connection = sqlite3.connect(folder / "default.db")
    models = {(row[0], row[1]) for row in connection.execute(
        "SELECT sumo_type, vehicle_model FROM crash_vehicle")}
    expected = {"plain": "mine", "little": "mine", "parcels": "van", "named": "suv",
                "mapped": "toyota_camry_2018", "own_file": "mine", "lorry": "rigid_truck"}
    check(models and all(expected.get(t, "none") == m for t, m in models), models)
    connection.close()

    # Names that are none, in the traffic's files and in the study's: named before anything runs.
    types = dict(TYPES)
    types["named"] = (types["named"][0], '<param key="crashpulse.model" value="limousine"/>', "", "")
    write_routes(routes, types)
    result = run(crashpulse, "run", study, "--db", folder / "bad.db", expect=2)
    check("names the model 'limousine'" in result.stderr and "small_car" in result.stderr,
          result.stderr)
    types["named"] = (types["named"][0], '<param key="crashpulse.model" value="./gone.yaml"/>', "", "")
    write_routes(routes, types)
    result = run(crashpulse, "run", study, "--db", folder / "bad.db", expect=2)
    check("gone.yaml" in result.stderr and "vehicle type" in result.stderr, result.stderr)
    write_routes(routes, TYPES)
    study.write_text(study.read_text().replace("toyota_camry_2018", "toyota"))
    result = run(crashpulse, "run", study, "--db", folder / "bad.db", expect=2)
    check("study.yaml:" in result.stderr and "no vehicle 'toyota' is shipped" in result.stderr,
          result.stderr)

    # The town's types crash as the class that they are called, whatever the study's default; without their
    # names, as the car that their class and size give.
    town = re.search(r"<vTypeDistribution.*</vTypeDistribution>",
                     pathlib.Path(arguments.town).read_text(), re.S).group(0)
    flows = "".join(f'<flow id="{name}" type="traffic" begin="{begin}" end="400" period="{period}" '
                    f'from="{start}" to="{end}" departSpeed="desired"/>'
                    for name, begin, period, start, end in FLOWS)
    by_size = {"small_car": "small_car", "compact_car": "small_car",
               "mid_size_car": "honda_accord_2014", "suv": "suv", "van": "van"}
    for named, default in ((True, "  default: cars/mine.yaml\n"), (False, "")):
        expected = {name: name for name in by_size} if named else by_size
        routes.write_text("<routes>" + (town if named else re.sub("<param[^>]*/>", "", town)) + flows +
                          "</routes>")
        study.write_text(STUDY.format(design="paired_seeds", duration_s=160, default=default))
        # A mapping of a type that is nowhere would do nothing.
        for command in (["plan", study], ["run", study, "--db", folder / f"town{named}.db"]):
            result = run(crashpulse, *command, expect=2)
            check("vehicles.types[0].type must be a vehicle type of a scenario, found 'mapped'; there "
                  "are traffic, small_car" in result.stderr, result.stderr)
        study.write_text(re.sub(r"  types: .*\n", "", study.read_text()) +
                         ("" if default else "  types: []\n"))
        result = run(crashpulse, "run", study, "--db", folder / f"town{named}.db")
        connection = sqlite3.connect(folder / f"town{named}.db")
        rows = {(row[0], row[1], row[2]) for row in connection.execute(
            "SELECT sumo_type, vehicle_model, chosen_by FROM vehicle_type_model")}
        rule = "sumo_type" if named else "class_and_size"
        check(rows == {(t, m, rule) for t, m in expected.items()}, rows)
        check(connection.execute("SELECT count(*) FROM crash_vehicle WHERE validity LIKE '%size%'")
              .fetchone()[0] == 0, "models of other sizes than the town's types")
        connection.close()
