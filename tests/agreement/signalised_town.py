#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""signalised_town.py FOLDER [--lefthand] [--sublane] [--careless SHARE]: a town as map imports look, made by netgenerate: uneven
blocks, streets of one to three lanes, traffic lights with permissive left turns whose drivers wait turned
inside the junction, right of way at the small ones, cars of all sizes, vans, buses, trucks and
motorcycles. The same files every time. With --careless that share of the cars look neither at foes nor at
who is in the junction, by SUMO's own knobs."""
import argparse
import pathlib
import random
import subprocess
import xml.etree.ElementTree

TYPES = (("small", 0.25, 'length="3.8" width="1.66" height="1.5"'),
         ("mid", 0.35, 'length="4.6" width="1.8" height="1.47"'),
         ("suv", 0.15, 'length="4.7" width="1.9" height="1.68"'),
         ("van", 0.12, 'vClass="delivery" length="5.5" width="2" height="2.3"'),
         ("truck", 0.05, 'vClass="truck" length="7.1" width="2.4" height="2.4"'),
         ("bus", 0.04, 'vClass="bus" length="12" width="2.5" height="3.1"'),
         ("motorcycle", 0.04, 'vClass="motorcycle" length="2.2" width="0.9" height="1.5"'))
CARELESS = 'jmIgnoreFoeProb="0.6" jmIgnoreFoeSpeed="50" jmIgnoreJunctionFoeProb="0.6"'


def network(path, lefthand):
    subprocess.run(
        ["netgenerate", "--grid", "--grid.number", "5", "--grid.length", "140", "--grid.attach-length", "150",
         "--perturb-x", "norm(0,14)", "--perturb-y", "norm(0,14)", "--seed", "11", "--tls.guess",
         "--tls.guess.threshold", "60", "--turn-lanes", "1", "--turn-lanes.length", "35",
         "--default.lanenumber", "2", "--random-lanenumber", "--random-priority", "--default.speed", "13.89",
         "--junctions.corner-detail", "5", "--no-turnarounds", "--lefthand", str(lefthand).lower(),
         "--output-file", str(path)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def fringe(path):
    """Edges that lead into the network, and out of it."""
    root = xml.etree.ElementTree.parse(path).getroot()
    ends = {j.get("id") for j in root.iter("junction") if j.get("type") == "dead_end"}
    edges = [e for e in root.iter("edge") if e.get("function") is None]
    return ([e.get("id") for e in edges if e.get("from") in ends],
            [e.get("id") for e in edges if e.get("to") in ends])


def demand(path, into, out_of, careless, seconds=900, every_s=0.55):
    draw = random.Random(20261130)
    kinds, weights = [name for name, _, _ in TYPES], [share for _, share, _ in TYPES]
    lines = ["<routes>"]
    for name, _, size in TYPES:
        lines.append(f'  <vType id="{name}" {size} sigma="0.5"/>')
        if careless:
            lines.append(f'  <vType id="{name}_careless" {size} sigma="0.5" {CARELESS}/>')
    for k in range(int(seconds / every_s)):
        start, kind = draw.choice(into), draw.choices(kinds, weights)[0]
        # Not back by the road it came.
        end = draw.choice([edge for edge in out_of if edge != start and set(edge) != set(start)])
        kind += "_careless" if draw.random() < careless else ""
        lines.append(f'  <trip id="{kind}.{k}" type="{kind}" depart="{k * every_s:.2f}" from="{start}" '
                     f'to="{end}" departLane="best" departSpeed="max"/>')
    path.write_text("\n".join(lines + ["</routes>\n"]))


def make(folder, lefthand=False, sublane=False, careless=0.0):
    """The .sumocfg of the town in a folder of its own."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    network(folder / "town.net.xml", lefthand)
    demand(folder / "town.rou.xml", *fringe(folder / "town.net.xml"), careless)
    lateral = '<processing><lateral-resolution value="0.4"/></processing>' if sublane else ""
    configuration = folder / "town.sumocfg"
    configuration.write_text('<configuration><input><net-file value="town.net.xml"/><route-files '
                             f'value="town.rou.xml"/></input>{lateral}</configuration>\n')
    return configuration


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--lefthand", action="store_true")
    parser.add_argument("--sublane", action="store_true")
    parser.add_argument("--careless", type=float, default=0.0)
    arguments = parser.parse_args()
    print(make(arguments.folder, arguments.lefthand, arguments.sublane, arguments.careless))
