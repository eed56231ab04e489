# SPDX-License-Identifier: GPL-3.0-or-later
"""Real SUMO traffic whose cars are drawn from vehicle classes: the same draws by any number of workers
and in every variant, others by another seed, simulated again from the database alone, and heavy
opponents with a severity."""
import argparse
import json
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
from crossing_study import assert_same, run  # noqa: E402

TYPES = {"plain": 'length="4.6" width="1.8"', "tall": 'length="4.7" width="1.85" height="1.7"',
         "bought": 'length="4.6" width="1.8"', "lorry": 'vClass="truck"', "line": 'vClass="bus"',
         "rider": 'vClass="motorcycle"'}
STUDY = """study: fleet
design: {design}
seed: {seed}
replications: 2
duration_s: 150
scenarios:
  - name: crossing
    sumocfg: net/crossing.sumocfg
    driver_errors:
      - {{model: failed_to_see, parameters: {{probability_1: 1}}}}
variants:
  - name: baseline
  - {{name: aeb, functions: [{{function: aeb}}]}}
vehicles:
{vehicles}"""
FLEET = """  fleet: default
  market:
    - {type: bought, class: pickup, share_1: 0.5}
    - {type: bought, class: small_car, share_1: 0.5}
"""
FLOWS = [("through", 0, 3.1, "west_in", "east_out"), ("left", 0.4, 4.3, "east_in", "south_out")]
HEAVY = {"lorry": "rigid_truck", "line": "bus"}

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True, help="folder of the crossing")
arguments = parser.parse_args()
crashpulse = arguments.crashpulse


def check(condition, *words):
    if not condition:
        sys.exit(" ".join(map(str, words)))


def cars(db):
    """{(replication number, SUMO id): {(model, drawn)}} over all variants and tables."""
    found = {}
    connection = sqlite3.connect(db)
    for sql in ("SELECT r.number, v.sumo_id, v.vehicle_model, v.drawn FROM crash_vehicle AS v JOIN crash AS c "
                "ON c.id = v.crash_id JOIN replication AS r ON r.id = c.replication_id",
                "SELECT r.number, v.sumo_id, v.vehicle_model, v.drawn FROM counterfactual_vehicle AS v JOIN "
                "crash AS c ON c.id = v.crash_id JOIN replication AS r ON r.id = c.replication_id"):
        for number, sumo_id, model, drawn in connection.execute(sql):
            found.setdefault((number, sumo_id), set()).add((model, drawn))
    connection.close()
    return found


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    shutil.copytree(arguments.network, folder / "net")
    study = folder / "study.yaml"
    vtypes = "".join(f'<vType id="{t}" sigma="0.5" probability="1" {a}/>' for t, a in TYPES.items())
    flows = "".join(f'<flow id="{f}" type="mixed" begin="{begin}" end="400" period="{period}" from="{start}" '
                    f'to="{end}" departSpeed="desired"/>' for f, begin, period, start, end in FLOWS)
    (folder / "net" / "crossing.rou.xml").write_text(
        f'<routes><vTypeDistribution id="mixed">{vtypes}</vTypeDistribution>{flows}</routes>')

    # Any number of workers.
    study.write_text(STUDY.format(design="counterfactual", seed=5, vehicles=FLEET))
    one, three = folder / "one.db", folder / "three.db"
    result = run(crashpulse, "run", study, "--db", one, "--jobs", "1")
    run(crashpulse, "run", study, "--db", three, "--jobs", "3")
    assert_same(one, three)
    check("rider" in result.stderr and "no shipped model of vClass motorcycle" in result.stderr, result.stderr)

    # The same car in every variant; classes by size or by the market; heavy ones by their class.
    drawn = cars(one)
    check(all(len(values) == 1 for values in drawn.values()), "a vehicle crashed as two cars")
    connection = sqlite3.connect(one)
    classes = {}
    for sumo_type, model, text in connection.execute("SELECT sumo_type, vehicle_model, drawn FROM crash_vehicle"):
        classes.setdefault(sumo_type, set()).add(model)
        if model != "none":
            values = json.loads(text)
            check("mass_kg" in values and "yaw_inertia_kg_m2" in values, sumo_type, text)
    check(classes["plain"] <= {"compact_car", "mid_size_car"} and classes["tall"] <= {"suv", "van"}, classes)
    check(classes["bought"] <= {"pickup", "small_car"}, classes)
    check(classes["rider"] == {"none"}, classes)
    check(all(classes[t] == {model} for t, model in HEAVY.items()), classes)
    masses = [row[0] for row in connection.execute(
        "SELECT mass_kg FROM crash_vehicle WHERE vehicle_model = 'mid_size_car' GROUP BY sumo_id, mass_kg")]
    check(len(set(masses)) > 3, "cars of one class weigh the same:", masses)

    # What is inside has a class of tests and its error, what is outside has none.
    bad = connection.execute(
        "SELECT count(*) FROM crash_vehicle WHERE (validity = 'inside') <> (evidence_class IS NOT NULL) OR "
        "(evidence_class IS NOT NULL AND olc_status = 'value' AND abs(class_error_g - class_error_1 * olc_g) > 1e-12) "
        "OR (evidence_class IS NULL AND class_error_g IS NOT NULL)").fetchone()[0]
    inside = connection.execute("SELECT count(*) FROM crash_vehicle WHERE validity = 'inside'").fetchone()[0]
    check(bad == 0 and inside > 0, bad, "contradictions,", inside, "inside")

    # Who meets a heavy vehicle has a severity, and it is marked.
    rows = connection.execute(
        "SELECT v.delta_v_m_s, v.validity, v.frontal, w.delta_v_m_s * w.mass_kg / (v.delta_v_m_s * v.mass_kg) "
        "FROM crash_vehicle AS v JOIN crash_vehicle AS w ON w.crash_id = v.crash_id AND w.role <> v.role "
        "WHERE w.vehicle_model IN ('rigid_truck', 'bus') AND v.vehicle_model NOT IN ('none', 'rigid_truck', 'bus') "
        "AND v.validity NOT LIKE '%no_contact%'").fetchall()
    check(rows and all(row[0] is not None and "opponent_structure" in row[1] for row in rows), rows)
    check(all(abs(row[3] - 1.0) < 1e-6 for row in rows), "momentum against heavy opponents", rows)

    # From the database alone, byte for byte.
    crashes = [row[0] for row in connection.execute(
        "SELECT id FROM crash WHERE validity NOT LIKE '%no_model%' AND validity NOT LIKE '%no_contact%' ORDER BY id")]
    connection.close()
    check(len(crashes) > 5, "few crashes:", crashes)
    for crash in crashes:
        again = subprocess.run([crashpulse, "crash", "--from", one, "--crash", str(crash)], capture_output=True,
                               text=True)
        check(again.returncode == 0 and "byte for byte" in again.stderr, again.stderr)
    check(run(crashpulse, "check", one).returncode == 0)

    # Another seed draws other cars for the same ids.
    study.write_text(STUDY.format(design="paired_seeds", seed=6, vehicles=FLEET))
    run(crashpulse, "run", study, "--db", folder / "six.db")
    other = cars(folder / "six.db")
    check(all(len(values) == 1 for values in other.values()), "a vehicle crashed as two cars by paired seeds")
    common = [key for key in drawn if key in other and not any(m == "none" for m, _ in drawn[key])]
    check(common and all(drawn[key] != other[key] for key in common), common[:3])

    # What the section may hold.
    for vehicles, words in (
            ("  fleet: mine\n", "vehicles.fleet must be default, found 'mine'"),
            ("  fleet: default\n  default: suv\n", "vehicles.fleet does not go with vehicles.default"),
            ("  market: [{type: plain, class: suv, share_1: 1}]\n", "vehicles.market needs vehicles.fleet"),
            (FLEET.replace("0.5", "0.3"), "must sum up to 1 with the other shares of type 'bought', found 0.6"),
            (FLEET.replace("small_car", "pickup"), "repeats 'bought' with class 'pickup'"),
            (FLEET.replace("small_car", "limousine"), "must be a vehicle class of the fleet, found 'limousine'"),
            (FLEET.replace("bought", "sold"), "vehicles.market[0].type must be a vehicle type of a scenario, "
                                              "found 'sold'")):
        study.write_text(STUDY.format(design="paired_seeds", seed=6, vehicles=vehicles))
        result = run(crashpulse, "plan", study, expect=2)
        check("study.yaml:" in result.stderr and words in result.stderr, vehicles, result.stderr)
