# SPDX-License-Identifier: GPL-3.0-or-later
"""The test programs of some rooms under valgrind: no invalid or uninitialised memory, nothing lost."""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("--source", required=True)
parser.add_argument("--build", required=True)
parser.add_argument("--rooms", nargs="+", required=True)
parser.add_argument("--only", default="", help="programs with this in their names")
a = parser.parse_args()
FOUND = 99
environment = {**os.environ, "CRASHPULSE_SOURCE": a.source, "CRASHPULSE_BUILD": a.build}
programs = sorted(p for room in a.rooms for p in pathlib.Path(a.build).resolve().glob(f"test_{room}_*")
                  if a.only in p.name and os.access(p, os.X_OK))
faults = 0
for program in programs:
    with tempfile.NamedTemporaryFile("r") as log:
        result = subprocess.run(["valgrind", "-q", f"--error-exitcode={FOUND}", "--leak-check=full",
                                 "--errors-for-leak-kinds=definite", f"--log-file={log.name}", program],
                                env=environment, cwd=a.build, capture_output=True, text=True)
        words = log.read()
    bad = result.returncode != 0 or "ERROR" in words
    faults += bad
    print(f"{program.name}: {'FAULT' if bad else 'nothing found'}", flush=True)
    if bad:
        print(words, result.stdout[-2000:], result.stderr[-2000:])
print(f"{len(programs)} programs under valgrind, {faults} with faults")
sys.exit(1 if faults or not programs else 0)
