#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""An animated crash in a headless browser: no errors, no requests, the slider moves the bodies, the
overlay comes and goes, three widths."""
import argparse
import json
import pathlib
import re
import subprocess
import unittest

from webdriver import Browser

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--vehicles", required=True)
parser.add_argument("--output", required=True, help="folder for pages and screenshots")
ARGS = parser.parse_args()
OUTPUT = pathlib.Path(ARGS.output)
VEHICLES = pathlib.Path(ARGS.vehicles)
HOSTILE = 'car</script><b>"&'


def animate(name, *arguments):
    page = OUTPUT / name
    subprocess.run([ARGS.crashpulse, "crash", *arguments, "--animate", page], check=True,
                   stdout=subprocess.DEVNULL)
    return page


class Animation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        OUTPUT.mkdir(parents=True, exist_ok=True)
        own = OUTPUT / "hostile.yaml"
        text = (VEHICLES / "fleet" / "small_car.yaml").read_text(encoding="utf-8")
        own.write_text(re.sub(r"^vehicle: .*$", f"vehicle: '{HOSTILE}'", text, flags=re.M))
        other = VEHICLES / "mid_size.yaml"
        # The comparison of the reference study: barrier against two equal cars.
        cls.wall = animate("animation-wall.html", other, "--speed", "56", "--overlay-against", other)
        cls.cars = animate("animation-cars.html", own, "--against", other, "--speed", "50",
                           "--offset", "500", "--angle", "12")
        cls.browser = Browser().__enter__()
        cls.addClassCleanup(cls.browser.__exit__)

    def setUp(self):
        self.browser.resize(1440, 900)
        self.browser.log("browser")
        self.browser.log("performance")

    def tearDown(self):
        entries = [e["message"] for e in self.browser.log("browser")]
        self.assertEqual(entries, [], "messages on the console")

    def open(self, page):
        self.browser.open(page.resolve().as_uri())
        self.browser.settle()

    def slide(self, time_ms):
        self.browser.run("""
            const slider = document.getElementById("time");
            slider.value = arguments[0];
            slider.dispatchEvent(new Event("input"));""", time_ms)

    def box(self, selector):
        """Left, top, width, height of a drawn element."""
        return self.browser.run("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                                "return [b.left, b.top, b.width, b.height];", selector)

    def text(self, selector):
        return self.browser.run("return document.querySelector(arguments[0]).textContent", selector)

    def count(self, selector):
        return self.browser.run("return document.querySelectorAll(arguments[0]).length", selector)

    def test_address_names_a_moment(self):
        page = self.wall.resolve().as_uri()
        self.browser.open(page + "#t=60&view=front")
        self.browser.settle()
        self.assertEqual(self.text("#clock"), "60.0 ms")
        self.assertEqual(self.browser.run("return document.getElementById('view').value"), "front")
        self.browser.run("location.hash = '#t=1e9'")
        self.browser.settle()
        self.assertEqual(self.browser.run("const t = document.getElementById('time');"
                                          "return t.value === t.max"), True)
        self.browser.run("location.hash = '#t=soon'")
        self.browser.settle()

    def test_requests_nothing_but_itself(self):
        self.open(self.wall)
        urls = []
        for entry in self.browser.log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                urls.append(message["params"]["request"]["url"])
        self.assertEqual([u for u in urls if not u.startswith(("file:", "data:", "blob:"))], [])
        page = self.wall.read_text(encoding="utf-8")
        self.assertEqual(re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', page), [])
        self.assertIn("Copyright 2010-2017 Mike Bostock", page)

    def test_names_stay_text(self):
        self.open(self.cars)
        self.assertEqual(self.text("h1"), f"{HOSTILE} at 50 km/h against mid_size")
        self.assertEqual(self.count("b"), 0)
        self.assertIn(HOSTILE, self.text("#legend"))

    def test_the_slider_moves_bodies_cursor_and_numbers(self):
        self.open(self.cars)
        body, member = ".car[data-series='0'] .body", ".car[data-series='0'] .longitudinal"
        before, length = self.box(body), self.box(".car[data-series='1'] .longitudinal")
        cursor = self.box("#chart-a .cursor")
        self.slide(50)
        after = self.box(body)
        self.assertGreater(after[0], before[0] + 10, "car a drove on")
        self.assertNotEqual(self.box(member), length)
        self.assertGreater(self.box("#chart-a .cursor")[0], cursor[0])
        self.assertIn("50.0 ms", self.text("#clock"))
        # The numbers beside are those of the pulse at that time.
        now, in_pulse = self.browser.run("""
            const v = JSON.parse(document.getElementById("data").textContent).runs[0].vehicles[0];
            const cells = document.querySelectorAll("#numbers tbody tr")[0].querySelectorAll("td");
            return [cells[cells.length - 2].textContent, v.pulse.v_km_h[50 / v.pulse.interval_ms]];""")
        self.assertAlmostEqual(float(now.replace("\u2212", "-")), in_pulse, delta=0.051)
        self.slide(0)
        self.assertEqual(self.box(body), before)

    def test_fronts_touch_at_the_beginning_and_shorten(self):
        self.open(self.wall)
        front, wall = self.box(".car:not(.over) .cross_member"), self.box(".wall")
        self.assertAlmostEqual(front[0] + front[2], wall[0], delta=3.0)
        longitudinal = ".car:not(.over) [data-part=longitudinal_left]"
        undeformed = self.box(longitudinal)[2]
        self.slide(60)
        self.assertLess(self.box(longitudinal)[2], 0.75 * undeformed)

    def test_the_overlay_comes_and_goes(self):
        self.open(self.wall)
        self.assertEqual((self.count(".car"), self.count(".car.over")), (3, 2))
        self.assertEqual(self.count("#chart-v .curve"), 3)
        self.browser.run("document.getElementById('overlay').click()")
        self.assertEqual((self.count(".car"), self.count(".car.over")), (1, 0))
        self.assertEqual(self.count("#chart-v .curve"), 1)
        self.assertEqual(self.count("#numbers tbody tr"), 3)

    def test_playing_goes_on_and_space_stops_it(self):
        self.open(self.cars)
        self.browser.run("document.getElementById('play').click()")
        moved = self.browser._call("POST", "/execute/async", {"args": [], "script": """
            const done = arguments[0], slider = document.getElementById("time");
            const look = () => Number(slider.value) > 0 ? done(true) : requestAnimationFrame(look);
            look();"""})
        self.assertTrue(moved)
        self.assertEqual(self.text("#play"), "Pause")
        self.browser.run("document.body.dispatchEvent(new KeyboardEvent('keydown', "
                         "{key: ' ', bubbles: true, cancelable: true}))")
        self.assertEqual(self.text("#play"), "Play")

    def test_everything_has_a_name(self):
        self.open(self.wall)
        unlabelled = self.browser.run("""
            return Array.from(document.querySelectorAll("select, input, button")).filter(n =>
                !(n.closest("label") && n.closest("label").textContent.trim()) &&
                !n.getAttribute("aria-label") && !n.textContent.trim()).length""")
        self.assertEqual(unlabelled, 0)
        self.assertEqual(self.count("#scene svg[aria-label], .charts svg[aria-label]"), 5)

    def test_three_widths_and_two_themes(self):
        for name, page in (("wall", self.wall), ("cars", self.cars)):
            self.open(page)
            self.slide(45)
            for width in (390, 768, 1440):
                for theme in ("light", "dark"):
                    self.browser.resize(width, 900)
                    self.browser.settle()
                    if self.browser.run("return document.documentElement.dataset.theme") != theme:
                        self.browser.run("document.getElementById('theme').click()")
                    self.browser.settle()
                    wide = self.browser.run("return document.documentElement.scrollWidth")
                    self.assertLessEqual(wide, width, "the page scrolls sideways")
                    picture = OUTPUT / f"animation-{name}-{width}-{theme}.png"
                    self.browser.screenshot(picture)
                    self.assertGreater(picture.stat().st_size, 15000)


if __name__ == "__main__":
    unittest.main(argv=["test_animation.py"], verbosity=1)
