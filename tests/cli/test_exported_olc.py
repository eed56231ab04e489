#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""OLC recomputed from exported pulses by other means than the program's: once from v_x and once
from a_x, by bisection on the OLC itself. The occupant flies free for 65 mm, then slows down evenly
over 235 mm more; the OLC is the deceleration with which it is as fast as the car just there."""
import argparse
import csv
import json
import os
import subprocess
import tempfile
import unittest

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--vehicles", required=True)
ARGS = parser.parse_args()

G0 = 9.80665
STEP_S = 5e-5  # ten to a sample


def fine_velocity(times, values):
    """v on a fine grid to 0.5 s, straight between samples, constant after the last."""
    fine, k = [], 0
    for n in range(int(0.5 / STEP_S) + 1):
        t = n * STEP_S
        while k + 1 < len(times) and times[k + 1] <= t:
            k += 1
        if k + 1 == len(times):
            fine.append(values[-1])
        else:
            share = (t - times[k]) / (times[k + 1] - times[k])
            fine.append(values[k] + share * (values[k + 1] - values[k]))
    return fine


def travel_until_as_fast(velocity, olc):
    """Relative travel of an occupant braked by olc (m/s2) when it is as slow as the car."""
    v0, flight = velocity[0], None
    occupant, travel = v0, 0.0
    for v in velocity:
        if flight is None and travel >= 0.065:
            flight = travel
        if flight is not None:
            occupant -= olc * STEP_S
            if occupant <= v:
                return travel
        travel += (occupant - v) * STEP_S
    return float("inf")


def olc_g(velocity):
    """The OLC: braked harder, the occupant stops short of 300 mm."""
    low, high = 0.01 * G0, 200.0 * G0
    for _ in range(50):
        middle = 0.5 * (low + high)
        if travel_until_as_fast(velocity, middle) > 0.300:
            low = middle
        else:
            high = middle
    return low / G0


def integrate(times, rates, start):
    values = [start]
    for k in range(1, len(times)):
        values.append(values[-1] + 0.5 * (rates[k] + rates[k - 1]) * (times[k] - times[k - 1]))
    return values


def crash(name, opponent, *configuration):
    """Reported vehicles, and rows of the exported raw pulse by vehicle."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "pulse.csv")
        command = [ARGS.crashpulse, "crash", os.path.join(ARGS.vehicles, name + ".yaml"),
                   *configuration, "--pulse", path, "--raw", "--format", "json"]
        if opponent:
            command += ["--against", os.path.join(ARGS.vehicles, opponent + ".yaml")]
        done = subprocess.run(command, text=True, capture_output=True, check=True)
        rows = {}
        with open(path, encoding="utf-8") as file:
            for row in csv.DictReader(file):
                rows.setdefault(row["vehicle"], []).append(row)
    return json.loads(done.stdout)["vehicles"], rows


CRASHES = [
    ("honda_accord_2014", None, "--speed", "25", "--offset", "350", "--angle", "30"),
    ("honda_accord_2014", None, "--speed", "35", "--offset", "1050", "--angle", "20"),
    ("honda_accord_2014", None, "--speed", "56"),
    ("toyota_camry_2018", None, "--speed", "57.09"),
    ("honda_accord_2014", "honda_accord_2014", "--speed", "56"),
    ("fleet/small_car", "fleet/suv", "--speed", "60", "--opponent-speed", "40", "--offset", "500"),
    ("honda_accord_2014", "fleet/van", "--speed", "20", "--opponent-speed", "30", "--angle", "-25"),
]


class ExportedOlc(unittest.TestCase):
    def test_recomputed_olc_agrees(self):
        checked = 0
        for name, opponent, *configuration in CRASHES:
            vehicles, rows = crash(name, opponent, *configuration)
            for vehicle in vehicles:
                if vehicle["olc_status"] != "value":
                    continue
                samples = rows[vehicle["role"]]
                times = [float(row["time_s"]) for row in samples]
                exported = [float(row["vx_m_s"]) for row in samples]
                integrated = integrate(times, [float(row["ax_m_s2"]) for row in samples],
                                       exported[0])
                for velocity in (exported, integrated):
                    with self.subTest(crash=(name, opponent, *configuration),
                                      role=vehicle["role"]):
                        self.assertAlmostEqual(olc_g(fine_velocity(times, velocity)),
                                               vehicle["olc_g"], delta=0.05)
                        checked += 1
        self.assertGreaterEqual(checked, 18)


if __name__ == "__main__":
    unittest.main(argv=["test_exported_olc.py"], verbosity=1)
