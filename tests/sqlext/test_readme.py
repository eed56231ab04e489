# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines db/README.md gives for Python, R and DuckDB, run on the invented study: each prints the medians
that the view olc_by_variant has. A tool that is not installed, or lacks its package, is named."""
import argparse
import os
import pathlib
import re
import sqlite3
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
for option in ("readme", "db", "extension", "rscript", "duckdb"):
    parser.add_argument("--" + option, default="")
arguments = parser.parse_args()

text = pathlib.Path(arguments.readme).read_text()
medians = sqlite3.connect(arguments.db).execute(
    "SELECT variant, olc_median_g FROM olc_by_variant ORDER BY variant").fetchall()
environment = dict(os.environ)
if environment.get("CRASHPULSE_PRELOAD"):
    environment["LD_PRELOAD"] = environment["CRASHPULSE_PRELOAD"]
    environment["ASAN_OPTIONS"] = "detect_leaks=0"


def lines_of(language, mark):
    for block in re.findall(rf"^```{language}\n(.*?)^```", text, re.M | re.S):
        if mark in block:
            return block.replace("demo.db", arguments.db).replace("build/crashpulse_sql.so", arguments.extension)
    raise AssertionError(f"db/README.md has no lines of {language} with {mark}")


def check(command, lines, ending):
    with tempfile.NamedTemporaryFile("w", suffix=ending) as file:
        file.write(lines)
        file.flush()
        if ending == ".sql":
            ran = subprocess.run([command], stdin=open(file.name), capture_output=True, text=True, env=environment)
        else:
            ran = subprocess.run([command, file.name], capture_output=True, text=True, env=environment)
    assert ran.returncode == 0, ran.stderr
    for variant, median in medians:
        found = [float(m) for m in re.findall(rf"{variant}\D+([0-9.]+)", ran.stdout)]
        assert any(abs(x - median) < 1e-3 for x in found), (variant, median, ran.stdout)


check(sys.executable, lines_of("python", "enable_load_extension"), ".py")
r = lines_of("r", "loadable.extensions")
if not arguments.rscript:
    print("R is not installed: its lines are not run")
elif subprocess.run([arguments.rscript, "-e", "library(RSQLite)"], capture_output=True).returncode:
    print("R has no RSQLite: its lines are not run")
else:
    check(arguments.rscript, r, ".R")
duck = lines_of("sql", "ATTACH")
if not arguments.duckdb:
    print("DuckDB is not installed: its lines are not run")
else:
    check(arguments.duckdb, duck, ".sql")
