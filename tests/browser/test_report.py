#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A report in a headless browser: no errors, no requests, filters agree with SQL, three widths."""
import argparse
import csv
import json
import math
import pathlib
import re
import sqlite3
import subprocess
import unittest
import xml.etree.ElementTree

from webdriver import Browser

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--db", required=True)
parser.add_argument("--output", required=True, help="folder for the report and screenshots")
parser.add_argument("--any-study", action="store_true", help="only what holds for every report")
ARGS = parser.parse_args()
OUTPUT = pathlib.Path(ARGS.output)
REPORT = OUTPUT / "report.html"
SCORECARD = pathlib.Path(__file__).resolve().parents[2] / "db" / "validation" / "scorecard.csv"
ANY_STUDY = ["the_scorecard_has_a_line_a_class", "requests_nothing_but_itself", "filters_agree_with_sql", "scope_shows_the_vehicles_inside_only", "sites_agree_with_sql",
             "a_pair_is_a_seed_run_with_both", "every_figure_has_words_and_a_table", "three_widths_and_two_themes"]

FIGURES = ["figure-rate", "figure-ecdf", "figure-difference", "figure-paired", "figure-scatter", "figure-map", "figure-sites",
           "figure-benefit", "figure-forest", "figure-above-delta-v", "figure-delta-v", "figure-convergence", "figure-risk"]
# In this order, from the question to what repeats the study.
SECTIONS = ["h-variants", "h-design", "h-rates", "h-quantiles", "h-contrasts", "h-where", "h-injuries", "h-pulses",
            "h-functions", "h-validity", "h-assessment", "h-reproduce"]

# What the downloads would write, caught instead of saved.
CATCH_DOWNLOADS = """
window.caught = [];
URL.createObjectURL = blob => { window.caught.push(blob); return "#"; };
"""


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        OUTPUT.mkdir(parents=True, exist_ok=True)
        subprocess.run([ARGS.crashpulse, "report", ARGS.db, "--output", REPORT], check=True)
        cls.page = REPORT.read_text(encoding="utf-8")
        cls.db = sqlite3.connect(f"file:{ARGS.db}?mode=ro", uri=True)
        cls.browser = Browser().__enter__()
        cls.addClassCleanup(cls.browser.__exit__)

    def setUp(self):
        self.browser.resize(1440, 900)
        self.browser.log("browser")
        self.browser.log("performance")
        self.browser.open(REPORT.resolve().as_uri())
        self.browser.settle()

    def tearDown(self):
        entries = [e["message"] for e in self.browser.log("browser")]
        self.assertEqual(entries, [], "messages on the console")

    def choose(self, scenario="", crash_type="", scope="all"):
        self.browser.run("""
            const set = (id, value) => { const s = document.getElementById(id); s.value = value;
                                         s.dispatchEvent(new Event("change")); };
            set("scenario", arguments[0]); set("crash-type", arguments[1]);
            document.querySelector(`input[name=scope][value=${arguments[2]}]`).click();
        """, scenario, crash_type, scope)

    def card(self, variant, figure):
        text = self.browser.run("return document.querySelector(`[data-variant='${arguments[0]}'] "
                                "[data-figure='${arguments[1]}']`).firstChild.textContent",
                                variant, figure)
        return text.replace("\u2009", "").replace("\u202f", "").replace(" ", "")

    def count(self, sql, *values):
        return self.db.execute(sql, values).fetchone()[0]

    def test_the_scorecard_has_a_line_a_class(self):
        with open(SCORECARD, encoding="utf-8") as file:
            shipped = list(csv.DictReader(file))
        head, *lines = self.browser.run(
            "return Array.from(document.querySelectorAll('#table-scorecard tr'), "
            "row => Array.from(row.cells, cell => cell.textContent))")
        self.assertEqual([line[0] for line in lines], list(dict.fromkeys(row["title"] for row in shipped)))
        self.assertEqual(head[1:], list(dict.fromkeys(row["vehicle"] for row in shipped)))
        for line in lines:
            for vehicle, cell in zip(head[1:], line[1:]):
                results = [row["result"] for row in shipped
                           if row["title"] == line[0] and row["vehicle"] == vehicle]
                kept, missed = results.count("kept"), results.count("missed")
                expected = f"{kept} of {kept + missed}" if kept + missed else "no bar" if "no bar" in results else "–"
                self.assertEqual(cell.split(";")[0], expected, line)
                self.assertEqual("missed" in cell, missed > 0)

    def test_requests_nothing_but_itself(self):
        urls = []
        for entry in self.browser.log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                urls.append(message["params"]["request"]["url"])
        self.assertEqual([u for u in urls if not u.startswith(("file:", "data:", "blob:"))], [])
        self.assertEqual(re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', self.page), [])

    def test_text_of_the_study_stays_text(self):
        question = self.count("SELECT question FROM study")
        self.assertIn("</script>", question)
        self.assertEqual(self.browser.run("return document.title"), "invented – crashpulse")
        self.assertEqual(
            self.browser.run("return document.getElementById('question').textContent"), question)

    def test_answer_and_licence_are_there(self):
        answer, conditions = self.browser.run("return ['answer', 'conditions'].map(id => document.getElementById(id).textContent)")
        frontal = self.count("SELECT frontal_crashes FROM olc_by_variant WHERE is_baseline = 1")
        inside = self.count("SELECT count(*) FROM crash_list WHERE variant = 'baseline' AND "
                            "crash_type = 'front-front' AND validity = 'inside'")
        # A sentence a treatment, its interval first; what it all rests on behind it, once.
        self.assertRegex(answer, r"^aeb: \d\.\d\d to \d\.\d\d times the rate of frontal crashes with baseline \(95 % interval; estimate ")
        self.assertEqual(answer.count("\n"), 0)
        self.assertIn(f"{frontal} frontal crashes with baseline ({inside} of them front-front", conditions)
        self.assertIn("failed_to_see with probability 0.05", conditions)
        self.assertIn("conditional on the assumed driver errors", conditions)
        self.assertIn("Copyright 2010-2017 Mike Bostock", self.page)
        # Injuries have a section of their own; none is said of OLC.
        for section in ("h-rates", "h-quantiles", "h-contrasts"):
            text = self.browser.run("return document.getElementById(arguments[0]).closest('section').textContent", section)
            self.assertNotIn("injur", text.lower())
        sections = self.browser.run("return Array.from(document.querySelectorAll('main section')).map(s => s.getAttribute('aria-labelledby'))")
        self.assertEqual(sections, SECTIONS)

    def table(self, selector):
        return self.browser.run("return Array.from(document.querySelectorAll(`${arguments[0]} tr`), row => Array.from(row.cells, cell => cell.textContent))", selector)

    def test_activations_are_those_of_the_counters(self):
        head, *rows = self.table("#table-functions")
        self.assertEqual(len(head), 11)
        self.assertEqual(len(rows), self.count(
            "SELECT count(*) FROM (SELECT DISTINCT scenario_id, variant_id FROM replication "
            "WHERE json_extract(counters, '$.\"aeb.activations\"') IS NOT NULL)"))
        for scenario, _, variant, function, hours, count, *_ in rows:
            known = self.db.execute(
                "SELECT sum(vehicle_h), sum(json_extract(counters, '$.\"aeb.activations\"')) FROM replication AS r "
                "JOIN scenario AS s ON s.id = r.scenario_id JOIN variant AS v ON v.id = r.variant_id "
                "WHERE r.status = 'done' AND s.name = ? AND v.name = ?", (scenario, variant)).fetchone()
            self.assertEqual(function, "aeb")
            self.assertEqual(hours, f"{known[0]:.1f}")
            self.assertEqual(float(count), known[1])

    def test_parameters_show_what_differs(self):
        head, *rows = self.table("#parameters-functions > .scroll")
        self.assertEqual(head, ["function", "default", "baseline", "aeb"])
        functions = json.loads(self.count("SELECT functions FROM variant WHERE name = 'aeb'"))
        stored = functions["aeb"]["parameters"] if isinstance(functions, dict) else functions[0]["parameters"]
        self.assertEqual(rows[0], ["aeb", "", "–", "yes"])
        shown = {row[0].removeprefix("aeb."): row for row in rows[1:]}
        # What is left out is at its default: it stands in the folded table.
        everything = {row[0].removeprefix("aeb."): row for row in self.table("#parameters-functions details")[2:]}
        self.assertEqual(sorted(everything), sorted(stored))
        for name, row in everything.items():
            self.assertEqual(float(row[3]), stored[name])
            self.assertEqual(name in shown, row[1] not in ("–", row[3]), name)
        head, *rows = self.table("#parameters-errors > .scroll")
        self.assertEqual(head[2:], [row[0] for row in self.db.execute("SELECT name FROM scenario ORDER BY number")])
        self.assertIn("failed_to_see", [row[0] for row in rows])

    def test_the_assessment_record_names_what_is_missing(self):
        head, *rows = self.table("#table-assessment")
        self.assertEqual(len(rows), 14)
        self.assertEqual(rows[0][1], self.count("SELECT question FROM study"))
        self.assertEqual([row[1].startswith("missing: assessment.") for row in rows[1:]], 13 * [True])
        self.assertIn("Missing: 13 of 14", self.browser.run("return document.getElementById('assessment-missing').textContent"))
        # What the program knows is there all the same.
        known = {row[0]: row[2] for row in rows}
        self.assertIn("failed_to_see", known["Driver behaviour"])
        inside, vehicles = self.db.execute("SELECT sum(validity = 'inside'), count(*) FROM crash_vehicle WHERE frontal").fetchone()
        self.assertIn(f"{inside} of {vehicles} frontally struck vehicles inside", known["Models and their validation"])

    def test_what_the_author_said_is_shown(self):
        # The same study with an assessment in its file, multi-line and with markup in it.
        path = OUTPUT / "said.db"
        path.unlink(missing_ok=True)
        said = sqlite3.connect(path)
        self.db.backup(said)
        said.execute("UPDATE study SET yaml = ?", ("study: x\nassessment:\n  target_market: <b>EU & UK</b>\n  limitations: >-\n    no rates\n    of traffic\n",))
        said.commit()
        said.close()
        page = OUTPUT / "said.html"
        subprocess.run([ARGS.crashpulse, "report", path, "--output", page], check=True)
        self.browser.open(page.resolve().as_uri())
        self.browser.settle()
        rows = {row[0]: row[1] for row in self.table("#table-assessment")}
        self.assertEqual(rows["Target region and time"], "<b>EU & UK</b>")
        self.assertEqual(rows["Limitations"], "no rates of traffic")
        self.assertTrue(rows["Projection"].startswith("missing: assessment.projection"))
        self.assertEqual(self.browser.run("return document.querySelectorAll('#table-assessment .missing').length"), 11)

    def test_variants_can_be_left_out(self):
        def count(selector):
            return self.browser.run("return document.querySelectorAll(arguments[0]).length", selector)
        points = count("#figure-scatter .point")
        self.browser.run("document.querySelector(\"#variants input[value='aeb']\").click()")
        baseline = self.count("SELECT count(*) FROM frontal_vehicle WHERE olc_g IS NOT NULL AND variant = 'baseline'")
        self.assertEqual(count("#figure-scatter .point"), baseline)
        self.assertLess(baseline, points)
        self.assertEqual(count("#cards .card"), 1)
        self.assertEqual(count("#table-contrasts tbody tr"), 0)
        # The last one cannot be taken away.
        self.browser.run("document.querySelector(\"#variants input[value='baseline']\").click()")
        self.assertEqual(count("#cards .card"), 1)
        self.browser.run("document.querySelector(\"#variants input[value='aeb']\").click()")
        self.assertEqual(count("#figure-scatter .point"), points)

    def test_sites_agree_with_sql(self):
        self.choose("left_turn", "front-side")
        sites = self.browser.run("return document.querySelectorAll('#figure-sites .site').length")
        self.assertEqual(sites, self.count("SELECT count(*) FROM crash_list WHERE scenario = 'left_turn' AND crash_type = 'front-side'"))

    def test_injuries_agree_with_sql(self):
        wanted = self.count("SELECT sum(1 / (1 + exp(5.08188 - 0.08715096 * 3.6 * w.delta_v_m_s / 1.1))) FROM crash_vehicle w "
                            "JOIN variant v ON v.id = w.variant_id WHERE v.name = 'aeb' AND w.contact_side = 'front'")
        shown = self.browser.run("""
            const row = Array.from(document.querySelectorAll("#table-injuries tbody tr")).map(r => Array.from(r.children).map(c => c.textContent))
                .find(r => r[0] === "aeb" && r[1] === "MAIS2+" && r[2] === "NASS-CDS");
            return row[5];""")
        self.assertEqual(shown, f"{wanted:.2f}")

    def test_crashes_above_a_severity_agree_with_sql(self):
        # The figure's own data: crashes above every whole g, by the larger of the struck vehicles.
        shown = self.browser.run("""
            document.querySelector("#figure-above details").open = true;
            document.querySelector("#figure-above details").ontoggle();
            return Array.from(document.querySelectorAll("#figure-above table tbody tr"),
                row => Array.from(row.children, cell => cell.textContent)).map(r => [r[0], Number(r[1]), Number(r[2]), Number(r[3]), Number(r[4])]);""")
        query = next(q for q in self.browser.run("return JSON.parse(document.getElementById('data').textContent).queries;")
                     if q["name"] == "crashes_above_severity")
        wanted = [list(row[:5]) for row in self.db.execute(query["sql"]).fetchall()]
        self.assertEqual(shown, wanted)
        self.assertGreater(sum(row[2] for row in wanted), 100)

    def content(self, figure):
        """The cells of a figure's table, by row."""
        return self.browser.run("""
            const details = document.querySelector(`#${arguments[0]} details`);
            details.open = true; details.ontoggle();
            return Array.from(document.querySelectorAll(`#${arguments[0]} table tbody tr`), row => Array.from(row.cells, cell => cell.textContent));""", figure)

    def test_delta_v_agrees_with_sql(self):
        rows = [row for row in self.content("figure-delta-v") if row[0] == "aeb"]
        wanted = [row[0] for row in self.db.execute(
            "SELECT DISTINCT round(3.6 * delta_v_m_s, 4) FROM frontal_vehicle WHERE variant = 'aeb' AND delta_v_m_s IS NOT NULL ORDER BY 1")]
        shown = sorted({float(row[1]) for row in rows})
        self.assertEqual(len(shown), min(len(wanted), len(shown)))
        self.assertGreater(len(shown), 20)
        for value in shown:
            self.assertLess(min(abs(value - w) for w in wanted), 1e-2)

    def test_what_is_laid_under_delta_v_is_drawn_and_in_the_table(self):
        # A part of the script that adds a distribution does so before the first drawing.
        count = "return document.querySelectorAll('#figure-delta-v .under').length"
        before = self.browser.run(count)
        page = OUTPUT / "under.html"
        page.write_text(self.page.replace("const under = what", "UNDER_DELTA_V.push(() => ({label: 'laid under', x: [10, 20], share: [0.5, 1], first: 0}));\nconst under = what"), encoding="utf-8")
        self.browser.open(page.resolve().as_uri())
        self.browser.settle()
        self.assertEqual(self.browser.run(count), before + 1)
        self.assertEqual(self.browser.run("return document.querySelectorAll('#figure-ecdf .under').length"), 0)
        self.assertEqual([row[1] for row in self.content("figure-delta-v") if row[0] == "laid under"], ["10", "20"])

    def test_the_forest_has_every_scenario_and_all_of_them(self):
        rows = self.content("figure-forest")
        scenarios = [row[0] for row in self.db.execute("SELECT name FROM scenario ORDER BY number")]
        self.assertEqual([row[1] for row in rows], [name.replace("_", " ") for name in scenarios] + ["all scenarios, stratified"])
        for name, row in zip(scenarios, rows):
            crashes, km = zip(*(self.db.execute("SELECT sum(frontal_crashes), sum(vehicle_km) FROM replication_crashes WHERE scenario = ? AND variant = ? "
                "AND replication IN (SELECT replication FROM replication_crashes WHERE scenario = ?1 GROUP BY 1 HAVING count(*) = 2)", (name, variant)).fetchone() for variant in ("baseline", "aeb")))
            self.assertEqual([int(row[6]), int(row[7])], list(crashes))
            self.assertAlmostEqual(float(row[2]), crashes[1] / km[1] / (crashes[0] / km[0]), places=4)
        # Stratified: Mantel and Haenszel's ratio lies between those of the scenarios.
        ratios = [float(row[2]) for row in rows]
        self.assertTrue(min(ratios[:-1]) <= ratios[-1] <= max(ratios[:-1]))
        drawn = self.browser.run("return document.querySelectorAll('#figure-forest .estimate').length")
        self.assertEqual(drawn, len(rows))
        self.choose(scenarios[0])
        self.assertEqual(len(self.content("figure-forest")), 1)

    def test_convergence_ends_at_the_figure_itself(self):
        last = self.content("figure-convergence")[-1]
        self.assertEqual(float(last[2]), float(self.content("figure-forest")[-1][2]))

    # Of a crash type front-front, as the mean of the drivers.
    def test_risk_curves_are_the_functions(self):
        def mean(eta, things):
            if not things:
                return 1 / (1 + math.exp(-eta))
            rest = 1 - sum(term["share"] for term in things[0])
            return rest * mean(eta, things[1:]) + sum(term["share"] * mean(eta + term["add"], things[1:]) for term in things[0])

        rows = {(row[1], row[0], float(row[3])): float(row[4]) for row in self.content("figure-risk")}
        compared = 0
        for name, level, c0, c1, per_si, terms in self.db.execute("SELECT name, level, coefficients ->> 0, coefficients ->> 1, "
                "CASE unit WHEN 'mph' THEN 1 / 0.44704 WHEN 'km/h' THEN 3.6 ELSE 1 END, terms FROM risk_function "
                "WHERE form = 'logistic' AND use_as = 'default'"):
            of = {}
            for term in json.loads(terms):
                if term["of"] != "crash_type":
                    of.setdefault(term["of"], []).append(term)
            shown = [(x, p) for (n, l, x), p in rows.items() if (n, l) == (name, level)]
            compared += len(shown)
            for x, p in shown:
                self.assertAlmostEqual(p, mean(c0 + c1 * x / 3.6 * per_si, list(of.values())), places=3)
        self.assertEqual(compared, len(rows))
        self.assertGreater(compared, 100)

    def test_a_pair_is_a_seed_run_with_both(self):
        for scenario, crash_type, scope in (("", "", "all"), ("left_turn", "front-side", "all"), ("", "front-front", "inside")):
            self.choose(scenario, crash_type, scope)
            rows = self.db.execute("""
                WITH seen AS (SELECT r.scenario_id, r.number, r.variant_id, avg(iif(w.censored, 0.0, w.olc_g)) AS olc_g
                    FROM frontal_vehicle AS w JOIN crash AS c ON c.id = w.crash_id JOIN replication AS r ON r.id = c.replication_id
                    WHERE w.olc_status <> 'simulation_failed' AND (?1 = '' OR w.scenario = ?1) AND (?2 = '' OR w.crash_type = ?2)
                      AND (?3 = 'all' OR w.validity = 'inside') GROUP BY 1, 2, 3)
                SELECT s.name || ', replication ' || b.number, b.olc_g, t.olc_g FROM seen AS b
                JOIN variant AS v ON v.id = b.variant_id AND v.is_baseline = 1
                JOIN seen AS t ON t.scenario_id = b.scenario_id AND t.number = b.number AND t.variant_id <> b.variant_id
                JOIN scenario AS s ON s.id = b.scenario_id""", (scenario, crash_type, scope)).fetchall()
            shown = self.browser.run("return Array.from(document.querySelectorAll('#figure-paired .point title')).map(t => t.textContent)")
            wanted = [f"aeb, {name}: {baseline:.1f} g, with the treatment {treated:.1f} g" for name, baseline, treated in rows]
            if not ARGS.any_study:
                self.assertGreater(len(wanted), 0)
            self.assertEqual(sorted(shown), sorted(wanted))

    def test_pointer_reads_values(self):
        text = self.browser.run("""
            const rect = document.querySelector("#figure-ecdf rect[style*='transparent']"), box = rect.getBoundingClientRect();
            rect.dispatchEvent(new MouseEvent("mousemove", {clientX: box.left + box.width / 2, clientY: box.top + 20, bubbles: true}));
            return document.querySelector("#figure-ecdf .readout").textContent;""")
        self.assertRegex(text, r"g.*baseline: \d+ %.*aeb: \d+ %")

    def test_filters_agree_with_sql(self):
        scenarios = [""] + [row[0] for row in self.db.execute("SELECT name FROM scenario")]
        types = [""] + [row[0] for row in self.db.execute("SELECT DISTINCT crash_type FROM crash_list WHERE frontal ORDER BY 1")]
        offered = self.browser.run("return Array.from(document.getElementById('crash-type').options).map(o => o.value)")
        self.assertEqual(offered, types)
        seen = set()
        for scenario in scenarios:
            for crash_type in types:
                self.choose(scenario, crash_type)
                for variant in ("baseline", "aeb"):
                    where = ("variant = ?1 AND (?2 = '' OR scenario = ?2) AND "
                             "(?3 = '' OR crash_type = ?3)")
                    values = (variant, scenario, crash_type)
                    crashes = self.count(f"SELECT count(*) FROM crash_list WHERE frontal AND {where}",
                                         *values)
                    vehicles = self.count(f"SELECT count(*) FROM frontal_vehicle WHERE {where}",
                                          *values)
                    self.assertEqual(self.card(variant, "frontal_crashes"), str(crashes))
                    self.assertEqual(self.card(variant, "frontal_vehicles"), str(vehicles))
                    seen.add(crashes)
                words = self.browser.run("return document.body.innerText")
                self.assertNotRegex(words, r"(?<![0-9.,\u2009 ])1 (frontal )?crashes\b")
                points = self.browser.run("return document.querySelectorAll('#figure-scatter .point').length")
                with_value = self.count("SELECT count(*) FROM frontal_vehicle WHERE olc_g IS NOT NULL "
                                        "AND (?1 = '' OR scenario = ?1) AND (?2 = '' OR crash_type = ?2)",
                                        scenario, crash_type)
                self.assertEqual(points, with_value)
        self.assertGreater(len(seen), 2 if ARGS.any_study else 8, "filters change the counts")

    def test_scope_shows_the_vehicles_inside_only(self):
        self.choose(scope="inside")
        points = self.browser.run("return document.querySelectorAll('#figure-scatter .point').length")
        self.assertEqual(points, self.count("SELECT count(*) FROM frontal_vehicle "
                                            "WHERE olc_g IS NOT NULL AND validity = 'inside'"))

    def test_downloads_hold_the_data_of_the_figures(self):
        self.browser.run(CATCH_DOWNLOADS)
        for figure in FIGURES:
            self.browser.run("document.querySelectorAll(`#${arguments[0]} .tools button`)"
                             ".forEach(b => b.click())", figure)
        texts = self.browser._call("POST", "/execute/async", {"args": [], "script":
            "const done = arguments[0]; Promise.all(window.caught.map(b => b.text())).then(done);"})
        self.assertEqual(len(texts), 2 * len(FIGURES))
        ecdf = texts[2].strip().split("\n")
        self.assertEqual(ecdf[0], "variant,olc_g,share,band_low,band_high")
        first_aeb = next(line for line in ecdf if line.startswith("aeb"))
        self.assertEqual(first_aeb.split(",")[1], "", "a censored curve starts above 0, without a value")
        self.assertGreater(float(first_aeb.split(",")[2]), 0.0)
        for svg in texts[1::2]:
            root = xml.etree.ElementTree.fromstring(svg)
            self.assertTrue(root.tag.endswith("svg"))
            self.assertNotIn("var(--", re.sub(r'style="[^"]*"', "", svg))

    def test_every_figure_has_words_and_a_table(self):
        for figure in FIGURES:
            label, rows = self.browser.run("""
                const node = document.getElementById(arguments[0]);
                node.querySelector("details").open = true;
                node.querySelector("details").ontoggle();
                return [node.querySelector("svg").getAttribute("aria-label"),
                        node.querySelectorAll("table tbody tr").length];""", figure)
            self.assertGreater(len(label), 10)
            self.assertGreater(rows, 0)
        unlabelled = self.browser.run("""
            return Array.from(document.querySelectorAll("select, input, button")).filter(n =>
                !n.closest("label") && !n.getAttribute("aria-label") && !n.textContent.trim()).length""")
        self.assertEqual(unlabelled, 0)

    def test_the_keyboard_alone_reaches_and_works_everything(self):
        reachable = self.browser.run("""
            return Array.from(document.querySelectorAll("select, input, button, summary, [tabindex='0'], a[href]"))
                .filter(n => n.checkVisibility() && !n.disabled).length""")
        # The radio buttons are one stop.
        radios = self.browser.run("return document.querySelectorAll('input[type=radio]').length") - \
            self.browser.run("return new Set(Array.from(document.querySelectorAll('input[type=radio]')).map(r => r.name)).size")
        self.browser.run("window.stops = new Set(); document.addEventListener('focusin', e => window.stops.add(e.target)); document.body.focus()")
        for _ in range(reachable + 5):
            self.browser.press("Tab")
        stops, unseen = self.browser.run("""
            return [window.stops.size, Array.from(window.stops).filter(n => { n.focus(); return getComputedStyle(n).outlineStyle === "none" && !n.classList.contains("skip"); }).length]""")
        self.assertGreaterEqual(stops, reachable - radios)
        self.assertEqual(unseen, 0, "the focus cannot be seen")

        # A filter, a scope, a variant and a table by keys.
        self.browser.run("document.getElementById('scenario').focus()")
        self.browser.press("ArrowDown")
        self.assertEqual(self.browser.run("return document.getElementById('scenario').value"), "left_turn")
        self.assertEqual(self.card("baseline", "frontal_crashes"), str(self.count(
            "SELECT count(*) FROM crash_list WHERE frontal AND variant = 'baseline' AND scenario = 'left_turn'")))
        self.browser.run("document.querySelector(\"#variants input[value='aeb']\").focus()")
        self.browser.press("Space")
        self.assertEqual(self.browser.run("return document.querySelectorAll('#cards .card').length"), 1)
        self.browser.run("document.querySelector('#figure-ecdf details summary').focus()")
        self.browser.press("Enter")
        self.browser.settle()
        self.assertGreater(self.browser.run("return document.querySelectorAll('#figure-ecdf table tbody tr').length"), 0)

    def test_prints_whole(self):
        self.browser.resize(718, 1000)
        self.browser.run("document.documentElement.dataset.theme === 'dark' || document.getElementById('theme').click()")
        self.browser.media("print")
        try:
            self.browser.settle()
            self.assertFalse(self.browser.run("return document.querySelector('.filters').checkVisibility()"))
            self.assertFalse(self.browser.run("return document.querySelector('.tools').checkVisibility()"))
            for figure in FIGURES:
                inside = self.browser.run("""
                    const svg = document.getElementById(arguments[0]).querySelector("svg").getBoundingClientRect();
                    return svg.width > 200 && svg.left >= 0 && svg.right <= document.documentElement.clientWidth;""", figure)
                self.assertTrue(inside, f"{figure} does not fit the paper")
            self.assertEqual(self.browser.run("return getComputedStyle(document.body).backgroundColor"),
                             "rgb(255, 255, 255)", "dark paper")
        finally:
            self.browser.media("screen")
            self.browser.run("document.getElementById('theme').click()")
        pdf = self.browser.pdf()
        (OUTPUT / "report.pdf").write_bytes(pdf)
        pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
        self.assertTrue(4 <= pages <= 40, f"{pages} pages")

    def test_three_widths_and_two_themes(self):
        for width in (390, 768, 1440):
            for theme in ("light", "dark"):
                self.browser.resize(width, 900)
                self.browser.settle()
                if self.browser.run("return document.documentElement.dataset.theme") != theme:
                    self.browser.run("document.getElementById('theme').click()")
                self.browser.settle()
                wide = self.browser.run("return document.documentElement.scrollWidth")
                self.assertLessEqual(wide, width, "the page scrolls sideways")
                outside = self.browser.run("""
                    return Array.from(document.querySelectorAll("figure svg text")).filter(t => {
                        const own = t.getBoundingClientRect(), box = t.closest("figure").getBoundingClientRect();
                        return own.width > 0 && (own.left < box.left || own.right > box.right); }).length""")
                self.assertEqual(outside, 0, "text of a figure is cut off")
                height = self.browser.run("return document.documentElement.scrollHeight")
                self.browser.resize(width, height)
                self.browser.settle()
                picture = OUTPUT / f"report-{width}-{theme}.png"
                self.browser.screenshot(picture)
                self.assertGreater(picture.stat().st_size, 20000)


if __name__ == "__main__":
    chosen = [f"Report.test_{name}" for name in ANY_STUDY] if ARGS.any_study else []
    unittest.main(argv=["test_report.py", *chosen], verbosity=1)
