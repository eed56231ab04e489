#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_field_data.py PROJECT DATABASE: db/field against the extract it was made from (where that is
there), the published figures, and table risk_function of a new database."""
import csv
import gzip
import importlib.util
import json
import math
import pathlib
import sqlite3
import sys
import unittest

PROJECT = pathlib.Path(sys.argv[1])
DATABASE = sys.argv[2]
FIELD = PROJECT / "db" / "field"
EXTRACT = PROJECT.parent / "shared" / "reference" / "nass_cds"
with_extract = unittest.skipUnless((EXTRACT / "frontal_car_crashes.csv").exists(),
                                   "../shared/reference/nass_cds is not there")


def load(name):
    spec = importlib.util.spec_from_file_location(name, FIELD / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def table_text():
    return gzip.decompress((FIELD / "nass_cds.csv.gz").read_bytes()).decode()


def shipped():
    """Of risk.csv: (model, level) -> rows."""
    fits = {}
    with open(FIELD / "risk.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            fits.setdefault((row["model"], row["level"]), []).append(row)
    return fits


class FieldTable(unittest.TestCase):
    def test_no_row_tells_more_than_its_columns(self):
        lines = [line for line in table_text().splitlines() if not line.startswith("#")]
        self.assertEqual(lines[0], "weight,stratum,cluster,crash_type,delta_v_kmh,pdof_deg,overlap_1")
        self.assertEqual(len(lines) - 1, 22941)

    @with_extract
    def test_table_is_what_the_script_makes(self):
        with open(EXTRACT / "frontal_car_crashes.csv", newline="", encoding="utf-8") as file:
            self.assertEqual(table_text(), load("field_table").table_of(csv.DictReader(file)))


class Risk(unittest.TestCase):
    @with_extract
    def test_fits_are_what_the_script_makes_and_what_was_published(self):
        risk = load("risk")
        drivers, stratum = risk.read(EXTRACT / "frontal_car_crashes.csv")
        self.assertEqual(len(drivers), 12024)
        published = {}
        with open(EXTRACT / "risk.csv", newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["section"] == "logit" and row["population"] == "two_vehicle belted":
                    published[row["model"], row["outcome"], row["term"]] = row
        names = {"delta_v": "M1 dv", "delta_v_type_age_sex": "M2 dv+type+age+sex"}
        terms = {"delta_v_km_h": "dv", "front-side": "front_side", "front-rear": "front_rear",
                 "age 35-54": "age35_54", "age 55-69": "age55_69", "age 70+": "age70up"}
        for (model, level), rows in shipped().items():
            fit = risk.fit(drivers, stratum, risk.MODELS[model], level)
            for i, row in enumerate(rows):
                self.assertAlmostEqual(fit["coefficients"][i] / float(row["coefficient"]), 1, 5)
                for j in range(i + 1):
                    scale = math.sqrt(fit["covariance"][i][i] * fit["covariance"][j][j])
                    self.assertLess(abs(fit["covariance"][i][j] - float(row[f"cov_{j}"])), 1e-5 * scale)
                other = published[names[model], level, terms.get(row["term"], row["term"])]
                self.assertAlmostEqual(float(row["coefficient"]) / float(other["value"]), 1, 4)
                self.assertAlmostEqual(math.sqrt(float(row[f"cov_{i}"])) / float(other["se_cluster"]), 1, 4)

    def test_default_functions_are_the_fits(self):
        names = {"NASS-CDS": "delta_v", "NASS-CDS with rebound": "delta_v",
                 "NASS-CDS by type and age": "delta_v_type_age_sex"}
        fits, seen = shipped(), 0
        for name, level, unit, coefficients, terms, covariance, freedom in sqlite3.connect(DATABASE).execute(
                "SELECT name, level, unit, coefficients, terms, covariance, freedom FROM risk_function "
                "WHERE name LIKE 'NASS%'"):
            rows = fits[names[name], level]
            terms = json.loads(terms)
            self.assertEqual(unit, "km/h")
            self.assertEqual(freedom, float(rows[0]["freedom"]))
            self.assertEqual(json.loads(coefficients) + [t["add"] for t in terms],
                             [float(r["coefficient"]) for r in rows])
            self.assertEqual([t["name"] for t in terms], [r["term"] for r in rows[2:]])
            for term, row in zip(terms, rows[2:]):
                if term["of"] != "crash_type":
                    self.assertEqual(term["share"], float(row["share"]))
            self.assertEqual(json.loads(covariance),
                             [float(r[f"cov_{j}"]) for i, r in enumerate(rows) for j in range(i + 1)])
            seen += 1
        self.assertEqual(seen, 8)

    def test_history_is_no_default(self):
        rows = sqlite3.connect(DATABASE).execute(
            "SELECT name, group_concat(DISTINCT use_as) FROM risk_function GROUP BY name").fetchall()
        self.assertEqual(dict(rows)["Malliaris"], "history")
        self.assertEqual(dict(rows)["GIDAS"], "offered")


class Rebound(unittest.TestCase):
    def setUp(self):
        self.db = sqlite3.connect(":memory:")
        sqlite3.connect(DATABASE).backup(self.db)
        self.crash, = self.db.execute("SELECT min(id) FROM crash WHERE crash_type = 'front-front'").fetchone()
        self.db.execute("UPDATE crash SET closing_speed_m_s = 20 WHERE id = ?", [self.crash])

    def change(self, role, delta_v, against, angle):
        """delta_v: its size; against: between it and the relative velocity, which has this angle in
        the car's axes."""
        self.db.execute("UPDATE crash_vehicle SET delta_v_m_s = ?, delta_v_x_m_s = ?, delta_v_y_m_s = ?, "
                        "velocity_angle_rad = ? WHERE crash_id = ? AND role = ?",
                        [delta_v, delta_v * math.cos(angle + against), delta_v * math.sin(angle + against),
                         angle, self.crash, role])

    def seen(self):
        return dict((role, (rebound, delta_v)) for role, rebound, delta_v in self.db.execute(
            "SELECT role, rebound_1, delta_v_without_rebound_m_s FROM delta_v_without_rebound "
            "WHERE crash_id = ?", [self.crash]))

    def test_cars_that_spring_apart(self):
        # Unlike masses, head-on but for the axes: 9 + 14 of 20 m/s are 15 % rebound.
        self.change("a", 9.0, 0.0, 0.2)
        self.change("b", 14.0, 0.0, -0.4)
        for role, whole in (("a", 9.0), ("b", 14.0)):
            rebound, delta_v = self.seen()[role]
            self.assertAlmostEqual(rebound, 0.15, 12)
            self.assertAlmostEqual(delta_v, whole / 1.15, 12)

    def test_only_what_lies_along_the_relative_velocity_counts(self):
        self.change("a", 12.0, 0.3, 0.0)
        self.change("b", 12.0, 0.3, 1.0)
        self.assertAlmostEqual(self.seen()["a"][0], 24.0 * math.cos(0.3) / 20.0 - 1.0, 12)

    def test_cars_that_slide_past_have_none(self):
        self.change("a", 6.0, 0.5, 0.0)
        self.change("b", 6.0, 0.5, 0.0)
        self.assertEqual(self.seen()["b"], (0.0, 6.0))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
