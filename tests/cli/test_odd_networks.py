# SPDX-License-Identifier: GPL-3.0-or-later
"""'crashpulse background' where SUMO's rectangles are not where vehicles are: trams and buses that stand
in a bend make no crash; two trains on one track meet at any step length."""
import argparse
import json
import math
import os
import pathlib
import subprocess
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
arguments = parser.parse_args()


def netconvert(folder, nodes, edges):
    (folder / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (folder / "n.edg.xml").write_text(f"<edges>{edges}</edges>")
    subprocess.run(["netconvert", "-n", "n.nod.xml", "-e", "n.edg.xml", "-o", "n.net.xml",
                    "--no-turnarounds", "true", "--xml-validation", "never"], cwd=folder, check=True,
                   capture_output=True, env={**os.environ, "SUMO_HOME": "/usr/share/sumo"})
    (folder / "n.sumocfg").write_text('<configuration><input><net-file value="n.net.xml"/>'
                                      '<route-files value="n.rou.xml"/></input></configuration>')


def crashes(folder, *words):
    result = subprocess.run([arguments.crashpulse, "background", folder / "n.sumocfg", "--format", "json",
                             *words], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return {row["reason"]: row["contacts"] for row in json.loads(result.stdout)
            if row["reported_by"] == "ours" and row["contacts"]}


def stands_in_bend(folder, radius, length, width, vclass, lane_m):
    """It stands in the middle of a bend of 90 degrees; small ones pass on the other lane."""
    leg = 100.0
    arc = [(radius * math.sin(math.radians(3 * k)), radius - radius * math.cos(math.radians(3 * k)))
           for k in range(31)]
    points = [(-leg, 0.0), *arc, (radius, radius + leg)]
    edges = "".join(
        f'<edge id="{name}" from="{a}" to="{b}" numLanes="1" width="{lane_m}" speed="13.9" shape="'
        + " ".join(f"{x:.2f},{y:.2f}" for x, y in shape) + '"/>'
        for name, a, b, shape in (("wn", "w", "n", points), ("nw", "n", "w", points[::-1])))
    netconvert(folder, f'<node id="w" x="{-leg}" y="0"/><node id="n" x="{radius}" y="{radius + leg}"/>', edges)
    place = leg + (radius + lane_m / 2) * math.pi / 4 + length / 2
    (folder / "n.rou.xml").write_text(
        f'<routes><vType id="long" vClass="{vclass}" length="{length}" width="{width}"/>'
        f'<vType id="car" length="4.5" width="{min(width, 1.8)}"/>'
        f'<vehicle id="long" type="long" depart="0" departPos="{length + 5}"><route edges="wn"/>'
        f'<stop lane="wn_0" endPos="{place:.2f}" duration="90"/></vehicle>'
        '<flow id="car" type="car" from="nw" to="nw" begin="40" end="90" period="10" departSpeed="max"/>'
        '</routes>')
    return crashes(folder, "--duration", "150")


def trains(folder, step_s):
    """Two rail cars at 50 m/s on one track, head on."""
    ways = {"there": ("ab", "bc", "cd"), "back": ("dc", "cb", "ba")}
    netconvert(folder, "".join(f'<node id="{n}" x="{1000 * k}" y="0"/>' for k, n in enumerate("abcd")),
               "".join(f'<edge id="{i}" from="{i[0]}" to="{i[1]}" numLanes="1" speed="50" allow="rail" '
                       'spreadType="center"/>' for way in ways.values() for i in way))
    (folder / "n.rou.xml").write_text(
        '<routes><vType id="rail" vClass="rail" length="20" width="2.8" maxSpeed="50" sigma="0" '
        'speedFactor="1" speedDev="0"/>' +
        "".join(f'<vehicle id="{name}" type="rail" depart="0" departPos="20" departSpeed="50" '
                f'insertionChecks="none"><route edges="{" ".join(way)}"/></vehicle>'
                for name, way in ways.items()) + "</routes>")
    return crashes(folder, "--step-length", str(step_s), "--duration", "60")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for case in ((100, 40, 2.4, "tram", 3.0), (30, 30, 2.4, "tram", 3.0), (22, 18, 2.55, "bus", 3.5)):
        found = stands_in_bend(folder, *case)
        assert "crash" not in found and found.get("long_vehicle_turning"), (case, found)
    for step_s in (0.1, 0.5, 1):
        found = trains(folder, step_s)
        assert found == {"crash": 1}, (step_s, found)
print("odd networks: as they should be")
