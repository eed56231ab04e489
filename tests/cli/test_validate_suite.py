#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""crashpulse validate --suite: columns, vehicles, skipping; the shipped quantiles and the shipped
scorecard are those that their commands make (where the single tests are at hand)."""
import argparse
import csv
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--source", required=True, help="the project's folder")
parser.add_argument("--few", action="store_true", help="one vehicle's scorecard: with sanitizers all take minutes")
ARGS = parser.parse_args()

VALIDATION = os.path.join(ARGS.source, "db", "validation")
SUITE = os.path.join(VALIDATION, "suite.yaml")
REFERENCES = os.path.join(ARGS.source, "..", "shared", "reference")
SEPARATION = os.path.join(REFERENCES, "iihs_small_overlap", "separation.csv")
ROW_COLUMNS = ("class,vehicle,quantity,unit,cases,reference,model,bias,mean_abs,max_abs,error_unit,"
               "inside_1,bar,result,note").split(",")
CASE_COLUMNS = ("class,vehicle,quantity,unit,case,time_ms,reference,low,high,model,error,error_unit,"
                "inside").split(",")


def call(*arguments, code=0):
    done = subprocess.run([ARGS.crashpulse, "validate", *arguments], text=True, capture_output=True,
                          check=False)
    assert done.returncode == code, (done.returncode, done.stderr)
    return done


def rows(*arguments):
    return list(csv.DictReader(call("--suite", SUITE, "--format", "csv", *arguments).stdout.splitlines()))


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class Suite(unittest.TestCase):
    def test_a_row_a_class_vehicle_and_quantity(self):
        found = rows("--vehicle", "honda_accord_2014")
        self.assertEqual(list(found[0]), ROW_COLUMNS)
        self.assertEqual({row["vehicle"] for row in found}, {"honda_accord_2014"})
        self.assertLessEqual({row["result"] for row in found}, {"kept", "missed", "no bar", "skipped"})
        table = [row for row in found if row["class"] == "olc_table"]
        own = json.loads(call(os.path.join(ARGS.source, "db/vehicles/honda_accord_2014.yaml"),
                              "--reference", os.path.join(ARGS.source, "db/reference/olc_accord_2014.csv"),
                              "--format", "json").stdout)
        self.assertEqual(int(table[0]["cases"]), 96)
        # A record that is only to be as long as its OLC looks less far ahead whether the two meet again.
        self.assertAlmostEqual(float(table[0]["mean_abs"]), own["mean_abs_error_g"], places=5)
        self.assertAlmostEqual(float(table[0]["max_abs"]), own["max_abs_error_g"], places=5)

    def test_cases_and_json_agree_with_the_rows(self):
        vehicle = ("--vehicle", "mid_size")
        found, cases = rows(*vehicle), rows(*vehicle, "--cases")
        self.assertEqual(list(cases[0]), CASE_COLUMNS)
        self.assertEqual(len(cases), sum(int(row["cases"]) for row in found))
        listed = json.loads(call("--suite", SUITE, *vehicle, "--cases", "--format", "json").stdout)
        self.assertEqual([len(row["list"]) for row in listed], [int(row["cases"]) for row in found])
        self.assertEqual(listed[0]["list"][0]["model"], float(cases[0]["model"]))
        self.assertIn("title", listed[0])

    def test_vehicles_are_names_or_files(self):
        path = os.path.join(ARGS.source, "db", "vehicles", "fleet", "small_car.yaml")
        found = rows("--vehicle", path, "--vehicle", "suv")
        self.assertEqual([row["vehicle"] for row in found[:3:2]], ["small_car", "suv"])
        foreign = [row for row in found if row["class"] == "olc_table"]
        self.assertEqual({row["result"] for row in foreign}, {"skipped"})
        self.assertIn("honda_accord_2014", foreign[0]["note"])

    def test_absent_references_are_skipped_with_a_word(self):
        with tempfile.TemporaryDirectory() as empty:
            found = rows("--vehicle", "mid_size", "--references", empty)
        poles = [row for row in found if row["class"].startswith("pole")]
        self.assertEqual({row["result"] for row in poles}, {"skipped"})
        self.assertIn("iihs_small_overlap/separation.csv is not among the references",
                      poles[0]["note"])
        self.assertEqual(poles[0]["model"], "")
        self.assertIn("kept", {row["result"] for row in found})

    def test_what_is_wrong_is_said(self):
        self.assertIn("no vehicle 'racer' is shipped", call("--suite", SUITE, "--vehicle", "racer", code=2).stderr)
        self.assertIn("absent.yaml", call("--suite", "absent.yaml", code=2).stderr)
        self.assertIn("go with --suite", call("--vehicle", "suv", code=2).stderr)
        self.assertIn("choose vehicles with --vehicle", call("--suite", SUITE, "car.yaml", code=2).stderr)


class Shipped(unittest.TestCase):
    def test_what_ships_names_its_source(self):
        for name in ("quantiles.csv", "nhtsa_oblique.csv", "reconstructed.csv"):
            self.assertIn("ource" if name == "quantiles.csv" else "SAE" if "oblique" in name else "CC BY 4.0",
                          read(os.path.join(VALIDATION, name)))

    def test_single_tests_of_the_populations_do_not_ship(self):
        table = [line for line in read(os.path.join(VALIDATION, "quantiles.csv")).splitlines()
                 if not line.startswith("#")]
        for row in csv.DictReader(table):
            self.assertGreaterEqual(int(row["tests"]), 15)
            self.assertLessEqual(float(row["p05"]), float(row["p50"]))
            self.assertLessEqual(float(row["p50"]), float(row["p95"]))

    @unittest.skipUnless(os.path.isdir(REFERENCES), f"{REFERENCES} is not there")
    def test_quantiles_are_those_of_the_tests(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, os.path.join(VALIDATION, "quantiles.py"), REFERENCES,
                            "--output", folder], check=True)
            for name in ("quantiles.csv", "nhtsa_oblique.csv", "reconstructed.csv"):
                self.assertEqual(read(os.path.join(folder, name)), read(os.path.join(VALIDATION, name)))

    @unittest.skipUnless(os.path.isfile(SEPARATION), f"{SEPARATION} is not there")
    def test_the_scorecard_is_of_the_shipped_vehicles(self):
        """Fails after a change of a vehicle or of the crash model: cmake --build build --target scorecard"""
        with tempfile.TemporaryDirectory() as folder:
            shipped = list(csv.DictReader(io.StringIO(read(os.path.join(VALIDATION, "scorecard.csv")))))
            if ARGS.few:
                new = rows("--vehicle", "mid_size")
                shipped = [row for row in shipped if row["vehicle"] == "mid_size"]
                # Classes of another vehicle alone are skipped with a word where this one is asked for.
                own = {row["class"] for row in shipped}
                new = [{name: row[name] for name in shipped[0] if name in row} for row in new
                       if row["class"] in own]
            else:
                subprocess.run([sys.executable, os.path.join(VALIDATION, "scorecard.py"), ARGS.crashpulse,
                                "--output", folder], check=True)
                new = list(csv.DictReader(io.StringIO(read(os.path.join(folder, "scorecard.csv")))))
            self.assertEqual(len(new), len(shipped))
            for one, other in zip(new, shipped):
                for column, value in one.items():
                    if column in ("reference", "model", "mean_abs", "max_abs", "inside_1") and value:
                        self.assertAlmostEqual(float(value), float(other[column]),
                                               delta=1e-3 * abs(float(value)) + 1e-6, msg=str(other))
                    elif column not in ("bias", "reference", "model", "mean_abs", "max_abs", "inside_1",
                                        "note"):
                        self.assertEqual(value, other[column], str(other))
            text = read(os.path.join(VALIDATION, "scorecard.md"))
            for row in shipped:
                self.assertIn(f"(`{row['class']}`)", text)

    @unittest.skipIf(ARGS.few, "of all vehicles")
    def test_evidence_is_that_of_the_scorecard(self):
        """Fails after a change of a scorecard, a vehicle or the boxes: cmake --build build --target evidence"""
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, os.path.join(VALIDATION, "evidence.py"), ARGS.crashpulse,
                            "--output", folder], check=True)
            new, shipped = ([row for row in csv.reader(io.StringIO(read(os.path.join(where, "evidence.csv"))))]
                            for where in (folder, VALIDATION))
            self.assertEqual(len(new), len(shipped))
            error = shipped[1].index("error_1")
            for one, other in zip(new[2:], shipped[2:]):
                self.assertAlmostEqual(float(one[error]), float(other[error]), delta=2e-3, msg=str(other))
                self.assertEqual(one[:error] + one[error + 1:], other[:error] + other[error + 1:])

    @unittest.skipUnless(os.path.isdir(REFERENCES), f"{REFERENCES} is not there")
    def test_vehicle_classes_are_those_of_the_tests(self):
        script = os.path.join(ARGS.source, "db", "vehicles", "fleet")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, os.path.join(script, "make_classes.py"), REFERENCES,
                            "--output", folder], check=True)
            subprocess.run([sys.executable, os.path.join(script, "make_heavy.py"), "--output", folder],
                           check=True)
            names = sorted(os.listdir(folder))
            self.assertIn("classes.csv", names)
            self.assertEqual(len(names), 1 + 2 * 7 + 4)
            for name in names:
                self.assertEqual(read(os.path.join(folder, name)), read(os.path.join(script, name)), name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
