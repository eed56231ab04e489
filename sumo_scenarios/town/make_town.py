#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make_town.py FOLDER: plain XML sources and demand of the town, always the same.

A grid of 11 x 11 junctions 160 m apart: every third street an arterial of two lanes each way, which
has priority; traffic lights where arterials cross, right of way elsewhere. Four rural roads of 2.5 km
lead out of the middle of each side, one lane each way, where cars may overtake on the opposite lane.
Cars of four sizes, sport utility vehicles and vans drive from edge to edge with fixed departures."""
import pathlib
import sys

SIZE, BLOCK_M, RURAL_M = 11, 160, 2500
HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n<!-- Made by make_town.py. -->\n'
folder = pathlib.Path(sys.argv[1])
folder.mkdir(parents=True, exist_ok=True)


def arterial(index):
    return index % 3 == 2


nodes, edges = [], []
for x in range(SIZE):
    for y in range(SIZE):
        lights = arterial(x) and arterial(y)
        kind = "traffic_light" if lights else "priority"
        nodes.append(f'    <node id="n{x}_{y}" x="{x * BLOCK_M}" y="{y * BLOCK_M}" type="{kind}"/>')


def road(a, b, lanes, speed, priority, may_overtake=False):
    for one, other in ((a, b), (b, a)):
        neighbour = f'<lane index="0"><neigh lane="{other}to{one}_0"/></lane>' if may_overtake else ""
        edges.append(f'    <edge id="{one}to{other}" from="{one}" to="{other}" numLanes="{lanes}" '
                     f'speed="{speed}" priority="{priority}">{neighbour}</edge>')


for x in range(SIZE):
    for y in range(SIZE):
        if x + 1 < SIZE:
            big = arterial(y)
            road(f"n{x}_{y}", f"n{x + 1}_{y}", 2 if big else 1, 13.89, 4 if big else 1 + y % 2)
        if y + 1 < SIZE:
            big = arterial(x)
            road(f"n{x}_{y}", f"n{x}_{y + 1}", 2 if big else 1, 13.89, 4 if big else 1 + x % 2)

# The rural roads and where they meet the town.
middle, last, far = SIZE // 2, SIZE - 1, (SIZE - 1) * BLOCK_M
rural = {"west": (f"n0_{middle}", -RURAL_M, middle * BLOCK_M),
         "east": (f"n{last}_{middle}", far + RURAL_M, middle * BLOCK_M),
         "south": (f"n{middle}_0", middle * BLOCK_M, -RURAL_M),
         "north": (f"n{middle}_{last}", middle * BLOCK_M, far + RURAL_M)}
for name, (gate, x, y) in rural.items():
    nodes.append(f'    <node id="{name}" x="{x}" y="{y}" type="dead_end"/>')
    road(name, gate, 1, 22.22, 3, may_overtake=True)

# Demand: rural roads to each other and into town, and between opposite and neighbouring rims of the
# town. Periods are primes in tenths of a second, so that every meeting differs.
rim = []
for k in range(SIZE - 1):
    rim.append((f"n{k}_0ton{k}_1", f"n{k}_{last}ton{k}_{last - 1}"))
    rim.append((f"n0_{k}ton1_{k}", f"n{last}_{k}ton{last - 1}_{k}"))
flows = []
for k, (one, other) in enumerate(rim):
    back = {one: one.split("to")[1] + "to" + one.split("to")[0],
            other: other.split("to")[1] + "to" + other.split("to")[0]}
    flows.append((one, back[other]))
    flows.append((other, back[one]))
    neighbour = rim[(k + 5) % len(rim)][0]
    flows.append((one, neighbour.split("to")[1] + "to" + neighbour.split("to")[0]))
names = list(rural)
for k, name in enumerate(names):
    gate = rural[name][0]
    opposite = {"west": "east", "east": "west", "south": "north", "north": "south"}[name]
    flows.append((f"{name}to{gate}", f"{rural[opposite][0]}to{opposite}"))
    flows.append((f"{name}to{gate}", rim[3 * k][0]))
    flows.append((rim[3 * k + 1][0], f"{gate}to{name}"))

PRIMES = [p for p in range(97, 600) if all(p % d for d in range(2, 25))]
rows = []
for k, (start, goal) in enumerate(flows):
    is_rural = start.split("to")[0] in rural or goal.split("to")[1] in rural
    period = PRIMES[(7 * k) % 20] / (8.0 if is_rural else 5.6)
    begin = (k * 37 % 101) / 10.0
    rows.append((begin, f'    <flow id="f{k}" type="traffic" begin="{begin}" end="360000" '
                        f'period="{period:.3f}" from="{start}" to="{goal}" departLane="best" '
                        f'departSpeed="desired"/>'))
rows.sort()
common = ('decel="3.5" emergencyDecel="8.0" sigma="0.4" actionStepLength="0.8" lcOpposite="1" '
          'speedFactor="normc(0.95,0.12,0.7,1.25)"')
# Each names the class that it crashes as, and has its size (sumo_scenarios/README.md, "Which car a SUMO vehicle
# crashes as"): whatever default a study has, a van stays a van.
types = [("small_car", 0.24, 3.9, 1.72, 1.5, 2.6, "passenger", "small_car"),
         ("compact_car", 0.26, 4.3, 1.79, 1.45, 2.6, "passenger", "compact_car"),
         ("mid_size_car", 0.22, 4.6, 1.83, 1.47, 2.6, "passenger", "mid_size_car"),
         ("suv", 0.16, 4.7, 1.90, 1.7, 2.4, "passenger", "suv"),
         ("van", 0.12, 5.9, 2.02, 2.5, 1.8, "delivery", "van")]
vtypes = "\n".join(f'        <vType id="{n}" vClass="{c}" probability="{p}" length="{l}" width="{w}" '
                   f'height="{h}" accel="{a}" {common}>\n'
                   f'            <param key="crashpulse.model" value="{m}"/>\n        </vType>'
                   for n, p, l, w, h, a, c, m in types)

(folder / "town.nod.xml").write_text(HEAD + "<nodes>\n" + "\n".join(nodes) + "\n</nodes>\n")
(folder / "town.edg.xml").write_text(HEAD + "<edges>\n" + "\n".join(edges) + "\n</edges>\n")
(folder / "town.rou.xml").write_text(
    HEAD + '<routes>\n    <vTypeDistribution id="traffic">\n' + vtypes +
    "\n    </vTypeDistribution>\n" + "\n".join(row for _, row in rows) + "\n</routes>\n")
