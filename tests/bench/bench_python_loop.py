# SPDX-License-Identifier: GPL-3.0-or-later
"""bench_python_loop.py STEPS SUMO_WORD...: what one would write with Python's libsumo: in each step
the state of every vehicle, near pairs by a grid, and whether their rectangles overlap. Its processor time
before every STEP_CLOCK_EVERYth step goes to the file STEP_CLOCK, as step_clock.cpp writes it."""
import math
import os
import sys
import time

import libsumo

CELL_M = 10.0


def corners(x, y, angle, length, width):
    heading = math.radians(90.0 - angle)
    c, s = math.cos(heading), math.sin(heading)
    half = 0.5 * width
    return [(x - l * c - w * s, y - l * s + w * c)
            for l, w in ((0.0, half), (length, half), (length, -half), (0.0, -half))]


def overlap(one, other):
    for shape in (one, other):
        for k in (0, 1):
            ax, ay = shape[k + 1][1] - shape[k][1], shape[k][0] - shape[k + 1][0]
            first = [ax * px + ay * py for px, py in one]
            second = [ax * px + ay * py for px, py in other]
            if max(first) < min(second) or max(second) < min(first):
                return False
    return True


libsumo.start(sys.argv[2:])
vehicle = libsumo.vehicle
size, touching, contacts = {}, set(), 0
clock, every = open(os.environ["STEP_CLOCK"], "w"), int(os.environ["STEP_CLOCK_EVERY"])
for step in range(int(sys.argv[1])):
    if step % every == 0:
        print(f"{time.process_time():.9f}", file=clock, flush=True)
    libsumo.simulationStep()
    grid, shape = {}, {}
    for name in vehicle.getIDList():
        if name not in size:
            size[name] = vehicle.getLength(name), vehicle.getWidth(name)
        (x, y), angle = vehicle.getPosition(name), vehicle.getAngle(name)
        vehicle.getSpeed(name)
        shape[name] = corners(x, y, angle, *size[name])
        grid.setdefault((int(x // CELL_M), int(y // CELL_M)), []).append(name)
    now = set()
    for (i, j), names in grid.items():
        near = [n for di in (-1, 0, 1) for dj in (-1, 0, 1) for n in grid.get((i + di, j + dj), ())]
        for one in names:
            for other in near:
                if one < other and overlap(shape[one], shape[other]):
                    now.add((one, other))
    contacts += len(now - touching)
    touching = now
libsumo.close()
print(contacts, "contacts")
