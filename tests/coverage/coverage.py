# SPDX-License-Identifier: GPL-3.0-or-later
"""Share of lines and branches of each room that the tests ran, from what a build with
CRASHPULSE_COVERAGE counted (gcov). Fails where a room stays below what is asked of it; --worst N
names the files with most that never ran."""
import argparse
import collections
import json
import pathlib
import subprocess
import sys

ASKED = {room: (85.0, 70.0) for room in ("crash", "pulse", "impact", "stats", "store", "exchange")}

parser = argparse.ArgumentParser()
parser.add_argument("--build", required=True)
parser.add_argument("--source", required=True)
parser.add_argument("--worst", type=int, default=0)
a = parser.parse_args()
source = pathlib.Path(a.source).resolve() / "src"

# A source that is compiled more than once ran where any of its objects ran.
lines, branches = collections.defaultdict(lambda: collections.defaultdict(int)), {}
for counted in sorted(pathlib.Path(a.build).resolve().glob("src/**/*.gcda")):
    found = subprocess.run(["gcov", "--json-format", "--branch-probabilities", "--stdout", counted],
                           cwd=a.build, capture_output=True, text=True, check=True)
    for unit in filter(None, found.stdout.splitlines()):
        for file in json.loads(unit)["files"]:
            path = pathlib.Path(a.build, file["file"]).resolve()
            if source not in path.parents:
                continue
            name = path.relative_to(source)
            taken = branches.setdefault(name, collections.defaultdict(int))
            for line in file["lines"]:
                lines[name][line["line_number"]] += line["count"]
                for k, branch in enumerate(line["branches"]):
                    if not branch["throw"]:
                        taken[line["line_number"], k] += branch["count"]


def share(counts):
    counts = list(counts)
    return 100.0 * sum(c > 0 for c in counts) / max(1, len(counts))


failed = False
print(f"{'room':12} {'lines':>7} {'ran %':>6} {'branches':>9} {'taken %':>8}")
for room in sorted({name.parts[0] for name in lines}):
    own = [name for name in lines if name.parts[0] == room]
    of_lines = [c for name in own for c in lines[name].values()]
    of_branches = [c for name in own for c in branches[name].values()]
    asked = ASKED.get(room, (0.0, 0.0))
    below = share(of_lines) < asked[0] or share(of_branches) < asked[1]
    failed |= below
    print(f"{room:12} {len(of_lines):7} {share(of_lines):6.1f} {len(of_branches):9} "
          f"{share(of_branches):8.1f}" + (f"  BELOW {asked[0]:g} and {asked[1]:g}" if below else ""))
missing = sorted(((sum(c == 0 for c in branches[name].values()), name) for name in lines), reverse=True)
for count, name in missing[:a.worst]:
    print(f"  {name}: lines {share(lines[name].values()):.1f} %, {count} branches never taken; lines "
          + " ".join(str(n) for n, c in sorted(lines[name].items()) if c == 0)[:400])
if not ASKED.keys() <= {name.parts[0] for name in lines}:
    sys.exit("nothing was counted: run the tests of a build with CRASHPULSE_COVERAGE first")
sys.exit(failed)
