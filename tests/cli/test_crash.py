#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse crash: the JSON and CSV that others build on, and what any crash must obey."""
import argparse
import contextlib
import csv
import io
import json
import os
import subprocess
import tempfile
import unittest

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--vehicle", required=True)
ARGS = parser.parse_args()

HEADER = "vehicle,time_s,ax_m_s2,ay_m_s2,vx_m_s,vy_m_s,x_m,y_m,yaw_rad,yaw_rate_rad_s,yaw_acc_rad_s2"


# A shipped vehicle with parameter scatter.
SCATTERED = os.path.join(os.path.dirname(ARGS.vehicle), "fleet", "small_car.yaml")


def crash(*arguments, code=0, vehicle=ARGS.vehicle):
    done = subprocess.run([ARGS.crashpulse, "crash", vehicle, *arguments], text=True,
                          capture_output=True, check=False)
    assert done.returncode == code, (done.returncode, done.stderr)
    return done


def as_json(*arguments):
    return json.loads(crash("--format", "json", *arguments).stdout)


def sampled(*arguments):
    return json.loads(crash("--format", "json", *arguments, vehicle=SCATTERED).stdout)


@contextlib.contextmanager
def vehicle_file(parameters):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "car.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(f"vehicle: car\nparameters:\n{parameters}\n")
        yield path


def pulses(*arguments):
    """Rows of the pulse file by vehicle, and its header."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "pulse.csv")
        crash("--pulse", path, *arguments)
        with open(path, encoding="utf-8") as file:
            text = file.read()
    rows = {}
    for row in csv.DictReader(io.StringIO(text)):
        rows.setdefault(row.pop("vehicle"), []).append({k: float(v) for k, v in row.items()})
    return text.split("\n", 1)[0], rows


class Crash(unittest.TestCase):
    def test_barrier_json(self):
        result = as_json("--speed", "56")
        self.assertEqual(result["configuration"]["against"], "barrier")
        self.assertAlmostEqual(result["configuration"]["speed_km_h"], 56.0)
        self.assertIsNone(result["configuration"]["opponent_speed_km_h"])
        (a,) = result["vehicles"]
        for key in ("role", "name", "olc_g", "olc_status", "delta_v_km_h", "peak_g", "t_v0_ms",
                    "crush_mm"):
            self.assertIn(key, a)
        self.assertEqual((a["role"], a["olc_status"]), ("a", "value"))
        self.assertGreaterEqual(a["delta_v_km_h"], 56.0, "it stops and rebounds")
        self.assertTrue(0 < a["t_v0_ms"] < 200)
        self.assertTrue(5 < a["olc_g"] < a["peak_g"] + 5)

    def test_two_cars_json(self):
        result = as_json("--speed", "50", "--against", ARGS.vehicle, "--opponent-speed", "70")
        a, b = result["vehicles"]
        self.assertEqual((a["role"], b["role"]), ("a", "b"))
        self.assertAlmostEqual(result["configuration"]["closing_speed_km_h"], 120.0)
        self.assertIsNone(a["t_v0_ms"], "defined against a barrier only")
        # Two cars of one model: the same change of velocity, whatever their speeds.
        self.assertAlmostEqual(a["delta_v_km_h"], b["delta_v_km_h"], delta=0.2)

    def test_opponent_is_as_fast_unless_said(self):
        configuration = as_json("--speed", "40", "--against", ARGS.vehicle)["configuration"]
        self.assertAlmostEqual(configuration["opponent_speed_km_h"], 40.0)

    def test_side_struck_has_no_olc(self):
        _, b = as_json("--speed", "50", "--against", ARGS.vehicle, "--angle", "90")["vehicles"]
        self.assertEqual(b["olc_status"], "not_front_contact")
        self.assertIsNone(b["olc_g"])

    def test_pulse_file(self):
        header, rows = pulses("--speed", "56", "--offset", "400", "--raw")
        self.assertEqual(header, HEADER)
        a = rows["a"]
        self.assertEqual(a[0]["time_s"], 0.0)
        self.assertAlmostEqual(a[0]["vx_m_s"], 56 / 3.6)
        self.assertGreaterEqual(a[-1]["time_s"], 0.2 - 1e-9)
        # v_x is v_x(0) and the integral of a_x.
        integral = sum(0.5 * (p["ax_m_s2"] + q["ax_m_s2"]) * (q["time_s"] - p["time_s"])
                       for p, q in zip(a, a[1:]))
        self.assertAlmostEqual(a[0]["vx_m_s"] + integral, a[-1]["vx_m_s"], delta=0.3)
        # Struck on the left, the car turns to the left (counter-clockwise, positive).
        self.assertGreater(a[-1]["yaw_rad"], 0.0)
        _, mirrored = pulses("--speed", "56", "--offset", "-400", "--raw")
        self.assertLess(mirrored["a"][-1]["yaw_rad"], 0.0)

    def test_filter_is_on_unless_raw(self):
        _, smooth = pulses("--speed", "56")
        _, raw = pulses("--speed", "56", "--raw")
        # How it bends: changes of the slope, which frequencies far above 60 Hz make.
        bends = [sum(abs(r["ax_m_s2"] - 2.0 * q["ax_m_s2"] + p["ax_m_s2"])
                     for p, q, r in zip(rows["a"], rows["a"][1:], rows["a"][2:])) for rows in (smooth, raw)]
        self.assertLess(bends[0], 0.8 * bends[1], "CFC60 smooths")
        self.assertEqual([r["vx_m_s"] for r in smooth["a"]], [r["vx_m_s"] for r in raw["a"]])

    def test_csv_has_a_row_a_vehicle(self):
        text = crash("--speed", "50", "--against", ARGS.vehicle, "--format", "csv").stdout
        rows = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual([row["role"] for row in rows], ["a", "b"])
        same = as_json("--speed", "50", "--against", ARGS.vehicle)["vehicles"]
        self.assertEqual(float(rows[1]["olc_g"]), same[1]["olc_g"], "all digits")

    def test_same_call_same_bits(self):
        arguments = ("--speed", "50", "--against", ARGS.vehicle, "--offset", "250", "--angle", "12")
        self.assertEqual(crash("--format", "json", *arguments).stdout,
                         crash("--format", "json", *arguments).stdout)

    def test_samples_give_an_interval_around_the_nominal_value(self):
        result = sampled("--speed", "50", "--samples", "60", "--seed", "3")
        self.assertEqual((result["samples"], result["seed"], result["missed"]), (60, 3, 0))
        (a,) = result["vehicles"]
        self.assertEqual(set(a["quantities"]), {"olc_g", "delta_v_km_h", "peak_g"})
        self.assertIn("mass_kg", a["scatter"])
        for name, q in a["quantities"].items():
            low, median, high = (q[key]["value"] for key in ("q05", "median", "q95"))
            self.assertTrue(low < median < high, name)
            self.assertTrue(low < q["nominal"] < high, name)
            self.assertEqual((q["count"], q["censored"]), (60, 0))
        alone = json.loads(crash("--speed", "50", "--format", "json", vehicle=SCATTERED).stdout)
        self.assertEqual(a["quantities"]["olc_g"]["nominal"], alone["vehicles"][0]["olc_g"])

    def test_samples_repeat_with_their_seed_only(self):
        call = ("--speed", "45", "--samples", "10", "--against", SCATTERED, "--offset", "300")
        self.assertEqual(sampled(*call, "--seed", "5"), sampled(*call, "--seed", "5"))
        self.assertEqual(sampled(*call), sampled(*call, "--seed", "1"))
        one, other = sampled(*call, "--seed", "5"), sampled(*call, "--seed", "6")
        self.assertNotEqual(one["vehicles"], other["vehicles"])
        self.assertEqual([v["role"] for v in one["vehicles"]], ["a", "b"])
        # Two cars of one file are drawn apart.
        olc = [v["quantities"]["olc_g"]["median"]["value"] for v in one["vehicles"]]
        self.assertNotAlmostEqual(olc[0], olc[1], delta=1e-6)

    def test_twice_the_scatter_doubles_the_interval(self):
        def width(scatter):
            with vehicle_file(f"  - {{name: mass_kg, value: 1640, scatter: {scatter}}}") as path:
                done = crash("--speed", "50", "--samples", "200", "--format", "json", vehicle=path)
            q = json.loads(done.stdout)["vehicles"][0]["quantities"]["peak_g"]
            return q["q95"]["value"] - q["q05"]["value"]
        self.assertAlmostEqual(width(0.04) / width(0.02), 2.0, delta=0.3)

    def test_left_censored_samples_are_counted(self):
        result = sampled("--speed", "1", "--samples", "8")
        olc = result["vehicles"][0]["quantities"]["olc_g"]
        self.assertEqual((olc["count"], olc["censored"], olc["censored_1"]), (8, 8, 1.0))
        self.assertIsNone(olc["median"])
        table = crash("--speed", "1", "--samples", "8", vehicle=SCATTERED).stdout
        self.assertIn("100.0 %", table)

    def test_samples_without_scatter_say_how_to_add_some(self):
        done = crash("--speed", "50", "--samples", "8", code=2)
        self.assertEqual(done.stdout, "")
        self.assertIn(ARGS.vehicle, done.stderr)
        self.assertIn("scatter: 0.03", done.stderr)

    def test_samples_as_csv(self):
        text = crash("--speed", "50", "--samples", "8", "--format", "csv", vehicle=SCATTERED).stdout
        rows = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual([r["quantity"] for r in rows], ["olc_g", "delta_v_km_h", "peak_g"])
        self.assertEqual(rows[0]["median_relation"], "=")
        self.assertTrue(float(rows[0]["q05"]) < float(rows[0]["q95"]))

    def test_what_is_wrong_with_an_overlay_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            page = os.path.join(folder, "page.html")
            done = crash("--speed", "50", "--animate", page, "--overlay-vehicle", "missing.yaml",
                         code=2)
            self.assertIn("overlay: missing.yaml", done.stderr)
            self.assertFalse(os.path.exists(page))

    def test_cars_that_miss_are_bad_input(self):
        done = crash("--speed", "50", "--offset", "5000", code=2)
        self.assertEqual(done.stdout, "")
        self.assertIn("miss", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=["test_crash.py"], verbosity=1)
