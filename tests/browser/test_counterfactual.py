#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a counterfactual study: the flow adds up and agrees with SQL."""
import argparse
import pathlib
import sqlite3
import subprocess
import unittest

from webdriver import Browser

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--db", required=True)
parser.add_argument("--output", required=True, help="folder for the report and a screenshot")
ARGS = parser.parse_args()
OUTPUT = pathlib.Path(ARGS.output)


class Counterfactual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        OUTPUT.mkdir(parents=True, exist_ok=True)
        report = OUTPUT / "counterfactual.html"
        subprocess.run([ARGS.crashpulse, "report", ARGS.db, "--output", report], check=True)
        cls.db = sqlite3.connect(f"file:{ARGS.db}?mode=ro", uri=True)
        cls.browser = Browser().__enter__()
        cls.addClassCleanup(cls.browser.__exit__)
        cls.browser.open(report.resolve().as_uri())
        cls.browser.settle()

    def test_flow_agrees_with_sql(self):
        for scenario in ("", "left_turn"):
            self.browser.run("""const s = document.getElementById("scenario"); s.value = arguments[0];
                                s.dispatchEvent(new Event("change"));""", scenario)
            text = self.browser.run("return document.getElementById('figure-flow').querySelector('svg').textContent")
            rows = self.db.execute("""SELECT outcome, count(*) FROM counterfactual_pair WHERE variant = 'aeb'
                AND baseline_crash_type LIKE 'front-%' AND (?1 = '' OR scenario = ?1) GROUP BY 1""", (scenario,)).fetchall()
            for outcome, count in rows:
                self.assertIn(f"{outcome.replace('_', ' ')} {count}", text)
            self.assertIn(f"{sum(count for _, count in rows)} crashes", text)

    def test_facets_are_what_treatments_made_of_the_crashes(self):
        text = self.browser.run("return document.getElementById('figure-map').querySelector('svg').textContent")
        self.assertIn("baseline", text)
        self.assertIn("aeb", text)
        self.assertNotRegex(text, r"\b0 crashes")

    def test_paired_change_has_both_readings(self):
        text = self.browser.run("return document.getElementById('figure-difference').querySelector('svg').textContent")
        self.assertIn("avoided = 0 g", text)
        self.assertIn("conditional on crashing", text)

    def test_every_valid_pair_is_a_point(self):
        self.browser.run("""const s = document.getElementById("scenario"); s.value = ""; s.dispatchEvent(new Event("change"));""")
        shown = self.browser.run("return document.querySelectorAll('#figure-paired .point').length")
        lower = self.browser.run("return document.getElementById('figure-paired').querySelector('svg').getAttribute('aria-label')")
        pairs, less = self.db.execute("""SELECT count(*), sum(treated_olc_g < baseline_olc_g) FROM counterfactual_pair
            WHERE baseline_crash_type LIKE 'front-%' AND outcome <> 'invalid' AND baseline_olc_g IS NOT NULL
            AND treated_olc_g IS NOT NULL""").fetchone()
        self.assertGreater(pairs, 3)
        self.assertEqual(shown, pairs)
        self.assertIn(f"{pairs} pairs, {less} less severe", lower)

    def test_the_table_of_treatments_holds_the_changes(self):
        self.browser.run("""const s = document.getElementById("scenario"); s.value = ""; s.dispatchEvent(new Event("change"));""")
        mean = self.db.execute("""SELECT avg(treated_olc_g - baseline_olc_g) FROM counterfactual_pair WHERE variant = 'aeb'
            AND baseline_crash_type LIKE 'front-%' AND outcome <> 'invalid' AND baseline_olc_g IS NOT NULL
            AND treated_olc_g IS NOT NULL""").fetchone()[0]
        shown = self.browser.run("""return Array.from(document.querySelectorAll("#table-contrasts tbody tr")).map(r => Array.from(r.children).map(c => c.textContent))
            .find(r => r[0] === "aeb" && r[1] === "mean change of OLC, g, avoided = 0")[2]""")
        self.assertEqual(shown.replace("\u2212", "-"), f"{mean:.1f}")

    def test_treated_crashes_are_in_every_figure(self):
        self.browser.run("""const s = document.getElementById("scenario"); s.value = ""; s.dispatchEvent(new Event("change"));""")
        treatments = self.db.execute("SELECT count(DISTINCT variant) FROM counterfactual_pair").fetchone()[0]
        names = [row[0] for row in self.db.execute("SELECT DISTINCT variant FROM counterfactual_pair ORDER BY 1")]
        self.assertGreater(treatments, 1)
        for figure in ("figure-above", "figure-above-delta-v", "figure-ecdf", "figure-delta-v"):
            curves = self.browser.run("return document.querySelectorAll(`#${arguments[0]} .curve`).length", figure)
            self.assertEqual(curves, 1 + treatments, figure)
        points = self.browser.run("return document.querySelectorAll('#figure-scatter .point').length")
        self.assertEqual(points, self.db.execute("""SELECT (SELECT count(*) FROM crash_vehicle WHERE olc_g IS NOT NULL AND frontal)
            + (SELECT count(*) FROM counterfactual_vehicle AS w JOIN crash AS c ON c.id = w.crash_id
               WHERE w.olc_g IS NOT NULL AND w.frontal AND c.crash_type LIKE 'front-%')""").fetchone()[0])
        for figure in ("figure-map", "figure-forest", "figure-convergence"):
            text = self.browser.run("return document.getElementById(arguments[0]).querySelector('svg').textContent", figure)
            for name in names:
                self.assertIn(name, text, figure)
        cards = self.browser.run("return Array.from(document.querySelectorAll('#cards .card'), c => c.dataset.variant)")
        self.assertEqual(sorted(cards), sorted(["baseline"] + names))

    def test_the_distribution_starts_at_what_was_avoided(self):
        self.browser.run("""const s = document.getElementById("scenario"); s.value = ""; s.dispatchEvent(new Event("change"));""")
        shown = self.browser.run("return Array.from(document.querySelectorAll('#figure-ecdf svg > g > text'), t => t.textContent)")
        avoided, crashes = self.db.execute("""WITH judged AS (SELECT crash_id FROM counterfactual_pair WHERE baseline_crash_type LIKE 'front-%'
            GROUP BY 1 HAVING sum(outcome = 'invalid' OR baseline_olc_g IS NULL OR treated_olc_g IS NULL) = 0)
            SELECT sum(outcome = 'avoided'), count(*) FROM counterfactual_pair JOIN judged USING (crash_id) WHERE variant = 'aeb'""").fetchone()
        self.assertGreater(avoided, 0)
        self.assertTrue(any(text.startswith(f"aeb (n = {crashes}, {avoided} avoided") for text in shown), shown)

    def test_three_widths(self):
        for width in (390, 768, 1440):
            self.browser.resize(width, 900)
            self.browser.settle()
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), width)
            outside = self.browser.run("""
                return Array.from(document.querySelectorAll("figure svg text")).filter(t => {
                    const own = t.getBoundingClientRect(), box = t.closest("figure").getBoundingClientRect();
                    return own.width > 0 && (own.left < box.left || own.right > box.right); }).map(t => t.textContent)""")
            self.assertEqual(outside, [], "text of a figure is cut off")

    def test_console_is_quiet_and_a_picture_is_left(self):
        self.assertEqual([e["message"] for e in self.browser.log("browser")], [])
        self.browser.run("document.getElementById('figure-flow').scrollIntoView()")
        self.browser.screenshot(OUTPUT / "counterfactual.png")
        self.assertGreater((OUTPUT / "counterfactual.png").stat().st_size, 20000)


if __name__ == "__main__":
    unittest.main(argv=["test_counterfactual.py"], verbosity=1)
