# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse assess against the study it stands in for: the same traffic is run by 'sumo', which
writes its collisions and floating car data, and by 'crashpulse run'; the crashes agree to what the
files' digits allow. Lists of configurations agree with 'crashpulse crash'."""
import argparse
import csv
import json
import math
import os
import pathlib
import re
import sqlite3
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True, help="folder of the crossing")
parser.add_argument("--vehicles", required=True)
arguments = parser.parse_args()
crashpulse = arguments.crashpulse
vehicles = pathlib.Path(arguments.vehicles)
network = pathlib.Path(arguments.network) / "crossing.net.xml"
# Sanitizers' preload is not for SUMO's program.
environment = {**os.environ, "SUMO_HOME": "/usr/share/sumo"}
environment.pop("LD_PRELOAD", None)


def run(*words, expect=0):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True,
                            env=environment)
    if result.returncode != expect:
        sys.exit(f"{words}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result


def rows(*words):
    return list(csv.DictReader(run(crashpulse, "assess", *words, "--format",
                                   "csv").stdout.splitlines()))


def crashes(database):
    return sqlite3.connect(database).execute(
        "SELECT a.sumo_id, b.sumo_id, c.time_s, c.closing_speed_m_s, c.lateral_offset_m, "
        "c.angle_rad, a.olc_g, b.olc_g, a.delta_v_m_s, c.crash_type, c.validity, a.vehicle_model, "
        "a.mass_kg, b.mass_kg, a.lane, b.lane, a.edge, b.junction "
        "FROM crash AS c JOIN crash_vehicle AS a ON a.crash_id = c.id AND a.role = 'a' "
        "JOIN crash_vehicle AS b ON b.crash_id = c.id AND b.role = 'b' ORDER BY c.number").fetchall()


def routes():
    """Pairs of a car and a van turning left before it without looking, each a little later."""
    types = "".join(f'<vType id="{name}" {size} sigma="0" speedDev="0" '
                    'jmIgnoreFoeProb="1" jmIgnoreFoeSpeed="100" jmIgnoreJunctionFoeProb="1"/>\n'
                    for name, size in (("car", 'length="4.5" width="1.8"'),
                                       ("van", 'vClass="delivery" length="5.5" width="2" height="2"')))
    departures = sorted([(10 + 20 * k, "through", k, "car") for k in range(10)] +
                        [(9 + 20.15 * k, "left", k, "van") for k in range(10)])
    return ("<routes>\n" + types + '<route id="through" edges="west_in east_out"/>\n'
            '<route id="left" edges="east_in south_out"/>\n' +
            "".join(f'<vehicle id="{route}.{k}" type="{kind}" route="{route}" depart="{at:.2f}" '
                    'departSpeed="desired"/>\n' for at, route, k, kind in departures) +
            "</routes>\n")


OURS = ["--step-method.ballistic", "true", "--collision.action", "warn",
        "--collision.mingap-factor", "0"]
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "x.rou.xml").write_text(routes())
    (folder / "x.sumocfg").write_text(
        f'<configuration><input><net-file value="{network}"/><route-files value="x.rou.xml"/>'
        "</input></configuration>\n")
    (folder / "x.yaml").write_text(
        "study: x\ndesign: independent\nseed: 1\nreplications: 1\nduration_s: 320\n"
        "scenarios:\n  - {name: x, sumocfg: x.sumocfg}\nvariants:\n  - name: baseline\n"
        f"vehicles:\n  default: {vehicles}/mid_size.yaml\n"
        f"  types: [{{type: van, model: {vehicles}/fleet/van.yaml}}]\n")

    def sumo(label, *options):
        length = [] if "--step-length" in options else ["--step-length", "0.05"]
        run("sumo", "-c", folder / "x.sumocfg", *length, "--no-step-log", "true",
            "--collision.check-junctions", "true", "--fcd-output", folder / f"{label}.fcd.xml",
            "--collision-output", folder / f"{label}.coll.xml", *options)
        return ["--collisions", folder / f"{label}.coll.xml", "--fcd", folder / f"{label}.fcd.xml",
                "--routes", folder / "x.rou.xml", "--vehicle", vehicles / "mid_size.yaml",
                "--type", f"van={vehicles}/fleet/van.yaml"]

    # The same crashes, roles, times, configurations and severities as the study's.
    assess = sumo("ours", *OURS, "--precision", "9")
    run(crashpulse, "run", folder / "x.yaml", "--db", folder / "run.db")
    found = rows(*assess, "--db", folder / "assess.db")
    ours, theirs = crashes(folder / "assess.db"), crashes(folder / "run.db")
    assert len(theirs) >= 5 and len(ours) == len(theirs) == len(found), (ours, theirs)
    for one, other in zip(ours, theirs):
        for mine, yours in zip(one, other):
            same = (math.isclose(mine, yours, rel_tol=1e-4, abs_tol=1e-4)
                    if isinstance(mine, float) else mine == yours)
            assert same, (one, other)
    for crash, row in zip(found, ours):
        assert (crash["a"], crash["b"]) == row[:2]
        assert math.isclose(float(crash["closing_speed_km_h"]), 3.6 * row[3])
        assert row[6] is None or math.isclose(float(crash["olc_a_g"]), row[6])
    # Where it was and how heavy the cars are is known of files too; who erred is not.
    assert all(row[14] and row[12] and row[16] for row in ours), ours
    for table, known in (("assess", 0), ("run", 1)):
        assert sqlite3.connect(folder / f"{table}.db").execute(
            "SELECT min(error_count IS NOT NULL), max(error_count IS NOT NULL), (SELECT count(*) FROM "
            "crash_function) FROM crash_vehicle").fetchone() == (known, known, 0)
    verdict = "SELECT found_as, count(*) FROM sumo_collision GROUP BY 1"
    check = run(crashpulse, "check", folder / "assess.db", "--format", "csv").stdout
    assert all(row["wrong"] == "0" for row in csv.DictReader(check.splitlines())), check
    assert sqlite3.connect(folder / "assess.db").execute(
        "SELECT design FROM study").fetchone() == ("assessment",)
    # Again: nothing new; another list into the same database is refused.
    before = crashes(folder / "assess.db")
    again = run(crashpulse, "assess", *assess, "--db", folder / "assess.db")
    assert "holds these crashes already" in again.stderr and crashes(folder / "assess.db") == before

    # SUMO's defaults: Euler's update, reports before contact, colliding vehicles put elsewhere. The
    # pairs are the same, those beyond the record carried on.
    defaults = sumo("sumo", "--precision", "9")
    other = rows(*defaults)
    assert [(c["a"], c["b"]) for c in other] == [row[:2] for row in theirs], other
    for crash, row in zip(other, theirs):
        assert abs(float(crash["closing_speed_km_h"]) / 3.6 - row[3]) < 0.6, (crash, row)
        assert abs(float(crash["time_s"]) - row[2]) < 0.2, (crash, row)
    refused = run(crashpulse, "assess", *defaults, "--db", folder / "assess.db", expect=2).stderr
    assert "assess.db: has results of another configuration" in refused, refused

    # Whoever SUMO calls collider: the same crashes to the digit.
    swapped = ElementTree.parse(folder / "ours.coll.xml")
    for row in swapped.getroot():
        for what in ("", "Type", "Speed"):
            mine, yours = row.get("collider" + what), row.get("victim" + what)
            row.set("collider" + what, yours)
            row.set("victim" + what, mine)
    swapped.write(folder / "swapped.xml")
    assert rows("--collisions", folder / "swapped.xml", *assess[2:]) == found

    # Where SUMO says itself where the two were (from 1.24 on; put here into what 1.15 wrote): without
    # the record of all vehicles, with rows that last and with single ones.
    steps = {step.get("time"): {vehicle.get("id"): vehicle for vehicle in step}
             for step in ElementTree.parse(folder / "ours.fcd.xml").getroot()}
    for only_first in (False, True):
        collisions = ElementTree.parse(folder / "ours.coll.xml")
        known = set()
        for row in list(collisions.getroot()):
            pair = frozenset((row.get("collider"), row.get("victim")))
            if only_first and pair in known:
                collisions.getroot().remove(row)
            known.add(pair)
            for role in ("collider", "victim"):
                there = steps[row.get("time")][row.get(role)]
                length = {"car": 4.5, "van": 5.5}[row.get(role + "Type")]
                yaw = math.radians(90.0 - float(there.get("angle")))
                x, y = float(there.get("x")), float(there.get("y"))
                row.set(role + "Front", f"{x:.4f},{y:.4f}")
                row.set(role + "Back",
                        f"{x - length * math.cos(yaw):.4f},{y - length * math.sin(yaw):.4f}")
        collisions.write(folder / "places.xml")
        placed = rows("--collisions", folder / "places.xml", *assess[4:])
        # The last pair barely touches, which ways that are told less well may miss.
        assert [(c["a"], c["b"]) for c in placed[:6]] == [row[:2] for row in ours[:6]], placed
        for crash, row in zip(placed[:6], ours):
            # Single rows do not tell SUMO's step, and so not whether theirs is its end or beginning.
            assert abs(float(crash["time_s"]) - row[2]) < (0.11 if only_first else 0.02), (crash, row)
            # Single rows do not tell turning either.
            off = float(crash["closing_speed_km_h"]) / 3.6 - row[3]
            assert abs(off) < (1.6 if only_first else 1.0), (crash, row)
    message = run(crashpulse, "assess", *assess[:2], *assess[4:], expect=2).stderr
    assert "ours.coll.xml:" in message and "without --fcd every <collision> must" in message, message

    # Without types of the two, those of the record hold.
    (folder / "old.xml").write_text(re.sub(r' (collider|victim)Type="[^"]*"', "",
                                           (folder / "ours.coll.xml").read_text()))
    assert rows("--collisions", folder / "old.xml", *assess[2:]) == found

    # A record of every fourth step: told, the times still those of SUMO's clock.
    words = sumo("sparse", *OURS, "--precision", "9", "--device.fcd.period", "0.2")
    result = run(crashpulse, "assess", *words, "--format", "csv")
    assert "holds one step every 0.2 s, SUMO made more" in result.stderr, result.stderr
    for crash, row in zip(csv.DictReader(result.stdout.splitlines()), ours[:6]):
        assert crash["a"] == row[0] and abs(float(crash["time_s"]) - row[2]) < 0.02, (crash, row)

    # Steps of 1 s in which SUMO takes the two away: what stays known is as with action warn, the
    # rest is said not to be, and nothing is made of where a vehicle was put.
    coarse = {}
    for action in ("warn", "teleport", "remove"):
        words = sumo(action, "--precision", "9", "--step-length", "1", "--collision.action", action,
                     "--collision.mingap-factor", "0")
        result = run(crashpulse, "assess", *words, "--format", "csv")
        coarse[action] = {(c["a"], c["b"]): c for c in csv.DictReader(result.stdout.splitlines())}
        if action != "warn":
            unknown = result.stderr.count("how they met is not known")
            assert unknown > 0, result.stderr
            assert len(coarse[action]) + unknown >= len(coarse["warn"]), result.stderr
            for pair, crash in coarse[action].items():
                of_warn = coarse["warn"].get(pair)
                assert of_warn is not None, pair
                for name in ("closing_speed_km_h", "offset_mm", "angle_deg", "time_s"):
                    assert math.isclose(float(crash[name]), float(of_warn[name]), rel_tol=0.01,
                                        abs_tol=0.1), (name, crash, of_warn)
    assert coarse["warn"]

    # Without a word about cars: by class and size of the vTypes.
    by_size = rows(*assess[:6])
    assert {(c["model_a"], c["model_b"]) for c in by_size} == {("van", "honda_accord_2014")}, by_size

    # Records of other runs, and what is wrong with a file, by line.
    fcd = (folder / "ours.fcd.xml").read_text()
    (folder / "empty.xml").write_text(
        '<fcd-export>\n<timestep time="0"/>\n<timestep time="0.05"/>\n</fcd-export>\n')
    wrong = ["--collisions", folder / "ours.coll.xml", "--fcd", folder / "empty.xml",
             "--vehicle", vehicles / "mid_size.yaml"]
    message = run(crashpulse, "assess", *wrong, expect=2).stderr
    assert "ours.coll.xml:" in message and "must be on the road around" in message, message
    (folder / "cut.xml").write_text(fcd[:len(fcd) // 2])
    wrong[3] = folder / "cut.xml"
    message = run(crashpulse, "assess", *wrong, expect=2).stderr
    assert "cut.xml:" in message and "is not XML" in message, message

    # A list of configurations: what 'crashpulse crash' says of each; b's front into a's side makes
    # b the one whose front is struck; poses lead to the configuration they were made from.
    (folder / "list.csv").write_text(
        "id,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg,vehicle_b\n"
        f"one,50,40,300,10,\ntwo,56,30,-200,0,{vehicles / 'fleet' / 'van.yaml'}\n")
    listed = rows("--configurations", folder / "list.csv", "--vehicle", vehicles / "mid_size.yaml",
                  "--db", folder / "list.db")
    for row, words in zip(listed, (
            ["mid_size.yaml", "--speed", 50, "--opponent-speed", 40, "--offset", 300, "--angle", 10],
            ["fleet/van.yaml", "--speed", 56, "--opponent-speed", 30, "--offset", -200, "--angle", 0])):
        alone = json.loads(run(crashpulse, "crash", vehicles / "mid_size.yaml", "--against",
                               vehicles / words[0], *words[1:], "--format", "json").stdout)
        assert math.isclose(float(row["olc_a_g"]), alone["vehicles"][0]["olc_g"]), (row, alone)
        assert math.isclose(float(row["olc_b_g"]), alone["vehicles"][1]["olc_g"]), (row, alone)
        assert row["validity_a"] == alone["vehicles"][0]["validity"], (row, alone)
    assert [row["a"] for row in listed] == ["one.a", "two.a"]
    assert sqlite3.connect(folder / "list.db").execute(
        "SELECT count(*), sum(vehicle_km) FROM crash, replication").fetchone() == (2, 0.0)
    (folder / "poses.csv").write_text(
        "x_a_m,y_a_m,heading_a_deg,speed_a_km_h,x_b_m,y_b_m,heading_b_deg,speed_b_km_h\n"
        "0,0,90,50,0.3,14,270,40\n0,0,0,30,3,-9,90,60\n")
    head_on, side = rows("--configurations", folder / "poses.csv", "--vehicle",
                         vehicles / "mid_size.yaml")
    assert abs(float(head_on["offset_mm"]) + 300) < 1e-6 and abs(float(head_on["angle_deg"])) < 1e-6
    assert math.isclose(float(head_on["closing_speed_km_h"]), 90.0)
    assert (side["a"], side["side_a"], side["side_b"]) == ("2.b", "front", "right"), side
    (folder / "poses.csv").write_text(
        "x_a_m,y_a_m,heading_a_deg,speed_a_km_h,x_b_m,y_b_m,heading_b_deg,speed_b_km_h\n"
        "0,0,0,50,0,14,0,40\n")
    message = run(crashpulse, "assess", "--configurations", folder / "poses.csv", "--vehicle",
                  vehicles / "mid_size.yaml", expect=2).stderr
    assert "poses.csv:2: the two must meet within" in message, message

    # One bad row among good ones is named and left out, the others are done, the exit code says so;
    # --strict ends there.
    head = "x_a_m,y_a_m,heading_a_deg,speed_a_km_h,x_b_m,y_b_m,heading_b_deg,speed_b_km_h\n"
    good = "0,0,90,50,0.3,14,270,40\n"
    (folder / "poses.csv").write_text(head + 50 * good + "0,0,0,50,0,14,0,40\n0,0,0,50,1,0,0,40\n" + 50 * good)
    words = ["--configurations", folder / "poses.csv", "--vehicle", "mid_size", "--format", "csv"]
    some = run(crashpulse, "assess", *words, "--db", folder / "some.db", expect=2)
    assert "poses.csv:52: the two must meet within" in some.stderr, some.stderr
    assert "poses.csv:53: x_b_m, y_b_m must leave the cars apart" in some.stderr, some.stderr
    assert "2 of 102 rows could not be assessed" in some.stderr, some.stderr
    assert len(some.stdout.splitlines()) == 101 and len(crashes(folder / "some.db")) == 100
    strict = run(crashpulse, "assess", *words, "--strict", "--db", folder / "strict.db", expect=2)
    assert "poses.csv:52" in strict.stderr and not strict.stdout, strict
    assert "poses.csv:53" not in strict.stderr and not (folder / "strict.db").exists(), strict

    # Likewise rows that cannot be read, or whose vehicles are none.
    (folder / "rows.csv").write_text(
        "\ufeffid;vehicle_a;vehicle_b;speed_a_km_h;speed_b_km_h;offset_mm;angle_deg\r\n"
        "one;van;suv;50;40;0;0\r\ntwo;van;suv;fast;40;0;0\r\nthree;nonsense;suv;50;40;0;0\r\n"
        "four;van;gone.yaml;50;40;0;0\r\none;van;suv;50;40;0;0\r\nsix;van;suv;50,5;40;0;0\r\nseven;suv;van;50;40;0;0\r\n")
    words = ["--configurations", folder / "rows.csv", "--format", "csv"]
    some = run(crashpulse, "assess", *words, expect=2)
    for said in ("rows.csv:3: speed_a_km_h must be a number, found 'fast'; left out",
                 "rows.csv:4: no vehicle 'nonsense' is shipped", "gone.yaml: cannot be read",
                 "rows.csv:6: id 'one' is given twice", "rows.csv:7: speed_a_km_h must be a number, found '50,5'",
                 "5 of 7 rows could not be assessed"):
        assert said in some.stderr, (said, some.stderr)
    assert [line.split(",")[2] for line in some.stdout.splitlines()[1:]] == ["one.a", "seven.a"], some.stdout
    strict = run(crashpulse, "assess", *words, "--strict", expect=2)
    assert "rows.csv:3" in strict.stderr and "rows.csv:4" not in strict.stderr and not strict.stdout, strict

    # Likewise a collision one of whose vehicles is not in the record.
    listed = (folder / "ours.coll.xml").read_text()
    name = re.search(r'collider="([^"]*)"', listed).group(1)
    (folder / "missing.coll.xml").write_text(listed.replace(f'collider="{name}"', 'collider="nobody"'))
    words = [folder / "missing.coll.xml" if word == folder / "ours.coll.xml" else word for word in assess]
    assert words != assess
    some = run(crashpulse, "assess", *words, "--format", "csv", expect=2)
    assert "'nobody' is not in the record" in some.stderr and "could not be assessed" in some.stderr, some
    assert len(some.stdout.splitlines()) > 5, some
    strict = run(crashpulse, "assess", *words, "--strict", expect=2)
    assert "'nobody' is not in the record" in strict.stderr and not strict.stdout, strict
