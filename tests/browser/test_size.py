#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of 10^5 crashes: under 10 MB, opens in under 3 s, counts as in the database.

`cmake --build build --target report_size` builds the study and runs this; it takes minutes."""
import argparse
import pathlib
import sqlite3
import subprocess
import time

from webdriver import Browser

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--db", required=True)
parser.add_argument("--output", required=True, help="the report to write")
ARGS = parser.parse_args()

started = time.monotonic()
subprocess.run([ARGS.crashpulse, "report", ARGS.db, "--output", ARGS.output], check=True)
made_s = time.monotonic() - started
page = pathlib.Path(ARGS.output)
size_mb = page.stat().st_size / 1e6
crashes = sqlite3.connect(f"file:{ARGS.db}?mode=ro", uri=True).execute(
    "SELECT count(*) FROM crash WHERE crash_type LIKE 'front-%'").fetchone()[0]

times = []
with Browser() as browser:
    for _ in range(3):
        browser.open("about:blank")
        browser.open(page.resolve().as_uri())
        browser.settle()
        times.append(browser.run("const t = performance.timing; return (t.loadEventEnd - t.navigationStart) / 1000"))
    selected = browser.run("return document.getElementById('status').textContent")
    sample = browser.run("return document.querySelectorAll('#figure-sites .site').length")
    errors = [e["message"] for e in browser.log("browser")]
print(f"{crashes} frontal crashes: made in {made_s:.0f} s, {size_mb:.1f} MB, opens in "
      f"{', '.join(f'{t:.2f}' for t in times)} s, {sample} crashes drawn")
assert errors == [], errors
assert "".join(c for c in selected.split(" frontal")[0] if c.isdigit()) == str(crashes), selected
assert size_mb < 10.0 and min(times) < 3.0
