# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of this folder share: their command line, small inputs, running the program in a
folder, and what a folder or a message is like."""
import argparse
import os
import re
import subprocess
import sys

LIST = ("id,vehicle_a,vehicle_b,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\n"
        "one,van,suv,50,40,0,0\n")
FIT = """fit: t
base: {base}
reference: reference.csv
output: {output}
algorithm: cmaes
seed: 1
population: {population}
generations: {generations}
starts: 1
slope_evaluations: 1
local_evaluations: 1
threads: 1
unknowns:
  - {{name: friction_1, min: 0.05, max: 0.5}}
"""
_OPTIONS = {"db": "a study's database", "network": "folder of the crossing", "vehicles": "db/vehicles"}


def parser(document, *options):
    """For --crashpulse and these of --db, --network, --vehicles, --samples."""
    found = argparse.ArgumentParser(description=document)
    found.add_argument("--crashpulse", required=True)
    for option in options:
        if option == "samples":
            found.add_argument("--samples", type=int, default=0, help="try so many; 0: all")
        else:
            found.add_argument("--" + option, required=True, help=_OPTIONS[option])
    return found


def fit(base="base.yaml", output="out.yaml", population=8, generations=1):
    return FIT.format(base=base, output=output, population=population, generations=generations)


def study(duration_s=10, scenario="", variants="", more="", replications=1, sumocfg="net/crossing.sumocfg"):
    """One scenario, with further keys of it, a baseline and further variants, each on lines of their own."""
    return (f"study: s\ndesign: paired_seeds\nseed: 5\nreplications: {replications}\n"
            f"duration_s: {duration_s}\n{more}scenarios:\n  - name: crossing\n    sumocfg: {sumocfg}\n"
            f"{scenario}variants:\n  - name: baseline\n{variants}")


def run(program, folder, *words, expect=None, limit_s=120, environment=None, **more):
    """In the folder, temporary files in there too; expect: exit codes that are right, all if None."""
    result = subprocess.run([program, *map(str, words)], cwd=folder, capture_output=True,
                            timeout=limit_s, env=dict(environment or os.environ, TMPDIR=str(folder)), **more)
    if expect is not None and result.returncode not in expect:
        sys.exit(f"{words}: exit code {result.returncode}\n{result.stdout.decode(errors='replace')}"
                 f"{result.stderr.decode(errors='replace')}")
    return result


def names(folder):
    """Everything that is there."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def state(folder):
    """The same with the content of files and the aims of links."""
    found = {}
    for path in folder.rglob("*"):
        name = str(path.relative_to(folder))
        if path.is_symlink():
            found[name] = "-> " + os.readlink(path)
        elif path.is_file():
            found[name] = path.read_bytes()
        else:
            found[name] = "other"
    return found


def has_message(text):
    return re.search("^crashpulse: error: .", text, re.M) is not None and "(null)" not in text


def control_characters(text, allowed="\n\t"):
    """Those that could act on a terminal."""
    return [c for c in text if (ord(c) < 32 and c not in allowed) or 0x7f <= ord(c) < 0xa0 or c == "\u202e"]
