#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse validate --pulse: a model against its own pulse, and the shipped Camry against the
real one (skipped where that test is not at hand)."""
import argparse
import csv
import json
import os
import subprocess
import tempfile
import unittest

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--source", required=True, help="the project's folder")
ARGS = parser.parse_args()

VEHICLES = os.path.join(ARGS.source, "db", "vehicles")
CAMRY = os.path.join(VEHICLES, "toyota_camry_2018.yaml")
TEST = os.path.join(ARGS.source, "..", "shared", "reference", "nhtsa_v10146_camry_2018")


def call(*arguments, code=0):
    done = subprocess.run([ARGS.crashpulse, *arguments], text=True, capture_output=True,
                          check=False)
    assert done.returncode == code, (done.returncode, done.stderr)
    return done


class OwnPulse(unittest.TestCase):
    def test_a_model_against_its_own_pulse(self):
        with tempfile.TemporaryDirectory() as folder:
            pulse = os.path.join(folder, "pulse.csv")
            where = ("--offset", "400", "--angle", "10")
            call("crash", CAMRY, "--speed", "50", *where, "--pulse", pulse)
            own = json.loads(call("validate", CAMRY, "--pulse", pulse, *where, "--format",
                                  "json").stdout)
            self.assertAlmostEqual(own["speed_km_h"], 50.0, places=6)
            self.assertLess(own["total_error"], 1e-3)
            self.assertIsNotNone(own["mae_vy_m_s"])
            self.assertAlmostEqual(own["olc_g"]["error"], 0.0, delta=0.01)
            other = json.loads(call("validate", os.path.join(VEHICLES, "mid_size.yaml"), "--pulse",
                                    pulse, *where, "--format", "json").stdout)
            self.assertGreater(other["total_error"], 1.0)
            rows = list(csv.DictReader(call("validate", CAMRY, "--pulse", pulse, *where, "--format",
                                            "csv").stdout.splitlines()))
            self.assertEqual([row["measure"] for row in rows][:2], ["olc_g", "t_v0_ms"])
            self.assertEqual(float(rows[0]["model"]), own["olc_g"]["model"], "all digits")

    def test_a_record_that_ends_early_has_no_olc(self):
        with tempfile.TemporaryDirectory() as folder:
            whole, cut = os.path.join(folder, "whole.csv"), os.path.join(folder, "cut.csv")
            call("crash", CAMRY, "--speed", "56", "--pulse", whole)
            with open(whole, encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            for end_s, known in ((0.06, False), (0.15, True)):
                with open(cut, "w", encoding="utf-8") as file:
                    file.write("time_s,ax_m_s2,vx_m_s\n" + "".join(
                        f"{row['time_s']},{row['ax_m_s2']},{row['vx_m_s']}\n" for row in rows
                        if row["vehicle"] == "a" and float(row["time_s"]) <= end_s))
                done = call("validate", CAMRY, "--pulse", cut, "--until", str(1000 * end_s),
                            "--format", "json")
                self.assertEqual(json.loads(done.stdout)["olc_g"]["reference"] is not None, known)
                self.assertEqual("cut.csv: ends at 60.0 ms, before its OLC is decided" in done.stderr,
                                 not known, done.stderr)

    def test_what_is_wrong_is_said(self):
        self.assertIn("needs the numbers of its channels", call("validate", CAMRY, "--pulse", VEHICLES, code=2).stderr)
        self.assertIn("holds no .EV5 file", call("validate", CAMRY, "--pulse", VEHICLES,
                                                 "--channels", "93", code=2).stderr)


@unittest.skipUnless(os.path.isdir(TEST), f"{TEST} is not there (NHTSA test 10146)")
class RealPulse(unittest.TestCase):
    def test_the_shipped_camry(self):
        with tempfile.TemporaryDirectory() as folder:
            curves = os.path.join(folder, "curves.csv")
            found = json.loads(call("validate", CAMRY, "--pulse", TEST, "--channels", "93,94",
                                    "--curves", curves, "--format", "json").stdout)
            with open(curves, encoding="utf-8") as file:
                rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
        self.assertEqual(found["reference"], "v10146.EV5, channels 93 and 94")
        self.assertAlmostEqual(found["speed_km_h"], 57.09, places=6)
        self.assertAlmostEqual(found["olc_g"]["reference"], 29.41, delta=0.01)
        self.assertAlmostEqual(found["t_v0_ms"]["reference"], 74.0, delta=0.1)
        self.assertLessEqual(found["mae_vx_m_s"], 0.5)
        self.assertLessEqual(abs(found["olc_g"]["error"]), 1.0)
        self.assertLessEqual(abs(found["t_v0_ms"]["error"]), 4.0)
        self.assertLessEqual(abs(found["crush_mm"]["error"]), 30.0)
        self.assertLessEqual(abs(found["peak_g"]["error"]), 5.0)
        self.assertIsNone(found["mae_vy_m_s"], "the sensors are longitudinal")

        # The error is that of the curves written.
        self.assertAlmostEqual(rows[-1]["time_s"], 0.12)
        mean = sum(abs(r["vx_m_s"] - r["reference_vx_m_s"]) for r in rows) / len(rows)
        self.assertAlmostEqual(mean, found["mae_vx_m_s"], places=6)

    def test_the_file_says_what_it_was_fitted_to(self):
        with open(CAMRY, encoding="utf-8") as file:
            text = file.read()
        for words in ("NHTSA test 10146", "channels 93 and 94", "mean abs. error of v_x"):
            self.assertIn(words, text)


if __name__ == "__main__":
    unittest.main(argv=["test_validate_pulse.py"], verbosity=1)
