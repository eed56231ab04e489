# SPDX-License-Identifier: GPL-3.0-or-later
"""Roads for two cars that do not know of each other: make_roads.py FOLDER writes nodes and edges. Every
road is an edge of its own through the same place, without a junction, so that SUMO's drivers keep
their speed. The own car comes from the west along y = 0."""
import math
import pathlib
import sys

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n'
STEPS = 180  # of an arc


def road(x, y, yaw, radius=None, turn=0.0, before=150.0, after=150.0):
    """Straight to (x, y) with that heading, an arc by turn (left positive), straight on."""
    points = [(x - before * math.cos(yaw), y - before * math.sin(yaw)), (x, y)]
    if radius:
        side = math.copysign(1.0, turn)
        centre = (x - side * radius * math.sin(yaw), y + side * radius * math.cos(yaw))
        for k in range(1, STEPS + 1):
            now = yaw + turn * k / STEPS
            points.append((centre[0] + side * radius * math.sin(now),
                           centre[1] - side * radius * math.cos(now)))
    end = yaw + turn
    points.append((points[-1][0] + after * math.cos(end), points[-1][1] + after * math.sin(end)))
    return points


# As in test_aeb_in_sumo.c and impact/test_detector_in_sumo.c: where each target's front is in the
# beginning.
ROADS = {
    "own": road(0.0, 0.0, 0.0, after=250.0),
    "oncoming": road(61.3, 0.0, math.pi),
    "oncoming_half": road(97.7, 0.9, math.pi),
    "oncoming_thin": road(97.7, 1.5, math.pi),
    "ahead": road(30.0, 0.4, 0.0, after=250.0),
    "behind": road(-20.0, -0.5, 0.0, after=250.0),
    "crossing": road(48.2, -2.0, math.pi / 2),
    "crossing_left": road(48.2, 2.0, -math.pi / 2),
    "crossing_oblique": road(38.9, 2.5, -math.pi / 3),
    "turning_across": road(52.4, 3.4, math.pi, 9.0, math.pi / 2),
    "turning_in": road(42.3, -9.0, math.pi / 2, 8.0, -math.pi / 2),
}

folder = pathlib.Path(sys.argv[1])
nodes, edges = [], []
for name, points in ROADS.items():
    for end, (x, y) in (("from", points[0]), ("to", points[-1])):
        nodes.append(f'    <node id="{name}_{end}" x="{x:.6f}" y="{y:.6f}"/>')
    shape = " ".join(f"{x:.6f},{y:.6f}" for x, y in points)
    edges.append(f'    <edge id="{name}" from="{name}_from" to="{name}_to" numLanes="1" speed="60" '
                 f'spreadType="center" shape="{shape}"/>')
(folder / "two_cars.nod.xml").write_text(HEAD + "<nodes>\n" + "\n".join(nodes) + "\n</nodes>\n")
(folder / "two_cars.edg.xml").write_text(HEAD + "<edges>\n" + "\n".join(edges) + "\n</edges>\n")
