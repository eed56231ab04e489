# SPDX-License-Identifier: GPL-3.0-or-later
"""What a database says about how a crash came about, against facts that have another source: lanes and
junctions against SUMO's network file, masses against the vehicle file, what functions did against the
recorded ways of the cars, driver errors against where the cars are and what the scenario has. The
scenarios are the demo's. The same rows for any number of workers and from merged parts."""
import argparse
import math
import pathlib
import re
import sqlite3
import sys
import tempfile
import xml.etree.ElementTree as xml

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True)
parser.add_argument("--scenarios", required=True, help="sumo_scenarios of the project")
arguments = parser.parse_args()
scenarios = pathlib.Path(arguments.scenarios)

STUDY = f"""study: how
design: paired_seeds
seed: 20261122
replications: 2
duration_s: 260
history_s: 8
scenarios:
  - name: left_turn
    sumocfg: {scenarios}/left_turn/left_turn.sumocfg
    driver_errors:
      - {{model: failed_to_see, parameters: {{probability_1: 0.4}}}}
      - {{model: misjudged_gap}}
  - name: head_on_overtaking
    sumocfg: {scenarios}/head_on_overtaking/head_on_overtaking.sumocfg
    driver_errors:
      - {{model: risky_overtaking, parameters: {{probability_1: 0.5, opposite_1: 3}}}}
      - {{model: lane_drift, parameters: {{rate_per_h: 40}}}}
variants:
  - name: baseline
  - name: assisted
    functions:
      - {{function: aeb, parameters: {{penetration_1: 0.7}}}}
      - {{function: fcw}}
      - {{function: elk}}
      - {{function: isa}}
vehicles:
  default: car.yaml
"""
MASS_KG = 1437.0


def run(*words, expect=0):
    return crossing_study.run(arguments.crashpulse, *words, expect=expect)


class Network:
    """Lanes, edges and junctions as SUMO's file has them."""

    def __init__(self, path):
        self.edge, self.shape, self.junction, ends_at = {}, {}, {}, {}
        root = xml.parse(path).getroot()
        for edge in root.iter("edge"):
            ends_at[edge.get("id")] = edge.get("to")
            for lane in edge.iter("lane"):
                self.edge[lane.get("id")] = edge.get("id")
                self.shape[lane.get("id")] = [tuple(map(float, point.split(",")[:2]))
                                              for point in lane.get("shape").split()]
        # A lane that a connection goes through lies in the junction where the edge before it ends.
        connections = sorted(root.iter("connection"), key=lambda c: c.get("from").startswith(":"))
        for connection in connections:
            before = f"{connection.get('from')}_{connection.get('fromLane')}"
            if connection.get("via"):
                self.junction[connection.get("via")] = (ends_at[connection.get("from")] or
                                                        self.junction[before])

    def near(self, lane, x, y):
        """Distance to the lane's centre line, and its heading there."""
        best = (math.inf, 0.0)
        for (x1, y1), (x2, y2) in zip(self.shape[lane], self.shape[lane][1:]):
            length = math.hypot(x2 - x1, y2 - y1)
            along = max(0.0, min(1.0, ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length ** 2))
            best = min(best, (math.hypot(x - x1 - along * (x2 - x1), y - y1 - along * (y2 - y1)),
                              math.atan2(y2 - y1, x2 - x1)))
        return best


def check_places(connection):
    networks = {name: Network(scenarios / name / f"{name}.net.xml")
                for name in ("left_turn", "head_on_overtaking")}
    inside = 0
    for scenario, lane, edge, junction, x, y in connection.execute(
            "SELECT w.scenario, w.lane, w.edge, w.junction, p.front_x_m, p.front_y_m FROM "
            "crash_vehicle_list AS w JOIN pre_crash_sample AS p USING (crash_id, role) GROUP BY "
            "w.crash_id, w.role HAVING p.number = max(p.number)"):
        network = networks[scenario]
        assert network.edge[lane] == edge, (scenario, lane, edge)
        assert network.junction.get(lane) == junction, (scenario, lane, junction)
        # The last sample is up to a step old; drifting and overtaking cars are beside the middle.
        assert network.near(lane, x, y)[0] < 8.0, (scenario, lane, x, y)
        inside += junction is not None
    assert inside > 4, inside
    return networks


def check_errors(connection, networks):
    of_scenario = {"left_turn": ["failed_to_see", "misjudged_gap"],
                   "head_on_overtaking": ["risky_overtaking", "lane_drift"]}
    rows = connection.execute(
        "SELECT w.scenario, e.crash_id, e.role, e.number, e.driver_error, e.towards, e.began_s, "
        "e.ended_s, e.is_cause FROM crash_driver_error AS e JOIN crash_vehicle_list AS w USING "
        "(crash_id, role)").fetchall()
    for scenario, *_, number, error, towards, began_s, ended_s, is_cause in rows:
        assert of_scenario[scenario][number] == error
        is_pairwise = scenario == "left_turn"
        assert (towards == "everybody") != is_pairwise, (error, towards)
        assert 0.0 <= ended_s <= began_s and ended_s <= 5.0
        assert is_cause == (towards != "another" and ended_s <= 3.0)
    found = {row[4] for row in rows if row[8]}
    assert found == {e for errors in of_scenario.values() for e in errors}, found

    # No background crashes in these scenarios: an error stands behind every crash.
    without = connection.execute("SELECT count(*) FROM crash WHERE id NOT IN (SELECT crash_id FROM "
                                 "crash_cause)").fetchone()[0]
    assert without == 0, without
    # at_fault is the same fact asked another way where errors are towards everybody.
    differ = connection.execute(
        "SELECT count(*) FROM crash_vehicle_list AS w WHERE scenario = 'head_on_overtaking' AND "
        "at_fault <> EXISTS (SELECT 1 FROM crash_driver_error AS e WHERE e.crash_id = w.crash_id "
        "AND e.role = w.role AND ended_s = 0)").fetchone()[0]
    assert differ == 0, differ
    # Who overtakes drives against the lane SUMO gives him, nobody else does.
    network = networks["head_on_overtaking"]
    overtaking = 0
    for lane, x, y, yaw, is_overtaking in connection.execute(
            "SELECT w.lane, p.front_x_m, p.front_y_m, p.yaw_rad, EXISTS (SELECT 1 FROM "
            "crash_driver_error AS e WHERE e.crash_id = w.crash_id AND e.role = w.role AND "
            "e.driver_error = 'risky_overtaking' AND ended_s = 0) FROM crash_vehicle_list AS w JOIN "
            "pre_crash_sample AS p USING (crash_id, role) WHERE scenario = 'head_on_overtaking' "
            "GROUP BY w.crash_id, w.role HAVING p.number = max(p.number)"):
        against = math.cos(yaw - network.near(lane, x, y)[1]) < 0.0
        overtaking += is_overtaking
        assert against or not is_overtaking, (lane, yaw)
    assert overtaking >= 3, overtaking


def check_functions(connection):
    assert connection.execute("SELECT count(*) FROM crash_function JOIN crash_vehicle_list USING "
                              "(crash_id, role) WHERE variant = 'baseline'").fetchone() == (0,)
    braked = exact = near = looked_at = steady = 0
    for (crash, role, function, braking_s, requested_s, warned_s, asked, reached, taken, speed, time_s,
         state, end_s) in connection.execute(
            "SELECT f.crash_id, f.role, function, braking_s, requested_s, warned_s, "
            "brake_request_m_s2, deceleration_m_s2, speed_taken_off_m_s, w.speed_m_s, c.time_s, state, "
            "max(p.time_s) FROM crash_function AS f JOIN crash_vehicle AS w USING (crash_id, role) JOIN "
            "crash AS c ON c.id = f.crash_id JOIN pre_crash_sample AS p USING (crash_id, role) "
            "WHERE braking_s IS NOT NULL GROUP BY f.crash_id, f.role, f.number"):
        begin_s = time_s - braking_s
        samples = connection.execute(
            "SELECT time_s, speed_m_s, acceleration_m_s2 FROM pre_crash_sample WHERE crash_id = ? AND "
            "role = ? ORDER BY number", (crash, role)).fetchall()
        if begin_s < samples[0][0]:
            continue
        # The car's speed at the end of the last step before its braking, by its recorded way; the speed
        # of a drifting car at contact is that along its axis, a little less than SUMO's.
        before = [s for s in samples if s[0] < begin_s - 1e-6][-1]
        if begin_s - before[0] < 0.05 - 1e-6:
            # The stored speed at contact is that of the way which the car's front makes in the step; of a
            # car that turns SUMO's is another. Against SUMO's own it is exact where the braking is steady.
            (_, _, earlier), (last_s, last, now) = samples[-2:]
            if state == "braking" and math.isclose(earlier, now, abs_tol=1e-9):
                at_contact = last + now * (time_s - last_s)
                assert math.isclose(taken, before[1] - at_contact, abs_tol=1e-6), (crash, role, function)
                steady += 1
            assert math.isclose(taken, before[1] - speed, abs_tol=0.5), (crash, role, function)
            near += math.isclose(taken, before[1] - speed, abs_tol=0.05)
            looked_at += 1
            exact += math.isclose(taken, before[1] - speed, abs_tol=1e-9)
        # The largest deceleration of whole steps since; the step of contact comes on top.
        steps = [-s[2] for s in samples if s[0] > before[0] + 1e-9]
        if state == "braking" and steps:
            assert reached >= max(steps) - 1e-9, (crash, role, reached, steps)
            assert reached <= max(max(steps), 9.9), (crash, role, reached)
        if function == "aeb":
            assert math.isclose(requested_s - braking_s, 0.2, abs_tol=1e-9) and warned_s is None
            # Jerk 40 m/s^3 up to 8 m/s^2, at the end of the step of contact.
            if state == "braking":
                assert math.isclose(asked, min(8.0, 40.0 * (end_s + 0.05 - begin_s)), abs_tol=1e-6)
        else:
            assert function == "fcw" and warned_s > braking_s and requested_s is None
        braked += 1
    assert braked >= 5 and exact >= braked / 2, (braked, exact)
    assert near >= 0.8 * looked_at, (near, looked_at)
    assert steady >= 5, steady
    # A car without AEB has none of it; everybody has the others.
    assert connection.execute(
        "SELECT DISTINCT function FROM crash_function WHERE state = 'not_equipped'").fetchall() == [
            ("aeb",)]
    assert connection.execute("SELECT count(*) FROM crash_function WHERE function = 'isa' AND state = "
                              "'limiting'").fetchone()[0] > 0


COUNTERFACTUAL = """counterfactual:
  time_series_s: 12
  horizon_s: 3
"""


def check_pairs(folder):
    """Functions of treated crashes against the time series of the branches."""
    study = crossing_study.write(folder, arguments.network, 1, 60, more=COUNTERFACTUAL)
    text = study.read_text().replace("design: paired_seeds", "design: counterfactual")
    study.write_text(text.replace("{function: aeb}", "{function: aeb, parameters: {ttc_s: 0.8}}"))
    db = folder / "pairs.db"
    run("run", study, "--db", db)
    run("check", db)
    connection = sqlite3.connect(db)
    # No branch looks beyond its horizon.
    late = connection.execute("SELECT max(treated_time_s - baseline_time_s) FROM counterfactual_pair").fetchone()[0]
    assert late <= 3.0, late
    treated = braking = 0
    for crash, role, asked, state, sampled in connection.execute(
            "SELECT f.crash_id, f.role, coalesce(f.brake_request_m_s2, 0), f.state, (SELECT "
            "s.brake_request_m_s2 FROM counterfactual_sample AS s WHERE (s.crash_id, s.variant_id, "
            "s.role) = (f.crash_id, f.variant_id, f.role) AND s.time_s <= x.time_s ORDER BY s.time_s "
            "DESC LIMIT 1) FROM counterfactual_function AS f JOIN counterfactual AS x USING (crash_id, "
            "variant_id) WHERE x.outcome <> 'changed_opponent'"):
        assert math.isclose(asked, sampled, abs_tol=1e-9), (crash, role, asked, sampled, state)
        treated += 1
        braking += asked > 0.0
    assert treated >= 6 and braking >= 3, (treated, braking)
    # The same car stays the same role, and errs in the same way.
    rows = connection.execute(
        "SELECT w.sumo_id = v.sumo_id, w.lane IS NOT NULL, w.mass_kg = v.mass_kg, (SELECT "
        "group_concat(driver_error || towards) FROM crash_driver_error AS e WHERE (e.crash_id, e.role) "
        "= (v.crash_id, v.role)) IS (SELECT group_concat(driver_error || towards) FROM "
        "counterfactual_driver_error AS e WHERE (e.crash_id, e.variant_id, e.role) = (w.crash_id, "
        "w.variant_id, w.role)) FROM counterfactual_vehicle AS w JOIN crash_vehicle AS v USING "
        "(crash_id, role) JOIN counterfactual AS x USING (crash_id, variant_id) WHERE x.outcome <> "
        "'changed_opponent'").fetchall()
    assert rows and all(all(row[:3]) for row in rows), rows
    assert sum(row[3] for row in rows) >= 0.7 * len(rows), rows
    connection.close()


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "car.yaml").write_text(
        "vehicle: car\nparameters:\n  - {name: mass_kg, value: %g, unit: kg, source: test}\n" % MASS_KG)
    (folder / "how.yaml").write_text(STUDY)
    run("run", folder / "how.yaml", "--db", folder / "one.db", "--jobs", 1)
    for shard in (1, 2):
        run("run", folder / "how.yaml", "--db", folder / f"part{shard}.db", "--jobs", 2, "--shard",
            f"{shard}/2")
    run("merge", folder / "both.db", folder / "part1.db", folder / "part2.db")
    one, both = crossing_study.rows(folder / "one.db"), crossing_study.rows(folder / "both.db")
    for table in ("crash", "crash_vehicle", "crash_driver_error", "crash_function"):
        assert one[table] == both[table] and one[table], table
    for db in ("one.db", "both.db"):
        run("check", folder / db)

    connection = sqlite3.connect(folder / "one.db")
    yaml = connection.execute("SELECT yaml FROM vehicle_model WHERE name = 'car'").fetchone()[0]
    mass_kg = float(re.search(r"name: mass_kg, value: ([0-9.]+)", yaml).group(1))
    assert connection.execute("SELECT DISTINCT mass_kg FROM crash_vehicle").fetchall() == [(mass_kg,)]
    check_errors(connection, check_places(connection))
    check_functions(connection)
    connection.close()
    check_pairs(folder)
