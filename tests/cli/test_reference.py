# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference page is the one that the program's tables give, every key on it has its meaning, and a word finds its
lines."""
import argparse
import pathlib
import subprocess

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--source", required=True, type=pathlib.Path)
arguments = parser.parse_args()


def reference(*words, code=0):
    done = subprocess.run([arguments.crashpulse, "reference", *words], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done


page = reference().stdout
undescribed = [line for line in page.splitlines() if "(no description)" in line]
assert not undescribed, "\n".join(undescribed) + "\nsay what these keys mean in src/cli/key_descriptions.h"
kept = (arguments.source / "sumo_scenarios/reference.md").read_text()
assert page == kept, "sumo_scenarios/reference.md is not current: cmake --build build --target reference"

# Keys that studies and vehicles of the project use stand there.
for key in ("study", "scenarios[].driver_errors[].model", "counterfactual.horizon_s", "assessment.limitations",
            "parameters[].scatter", "unknowns[].min", "classes[].compare[].bar.inside_1"):
    assert f"| `{key}` |" in page, key
for name in ("`failed_to_see` | `probability_1`", "`aeb` | `ttc_s`", "`mass_kg` | kg"):
    assert name in page, name
lines = reference("horizon").stdout.splitlines()
assert len(lines) == 1 and "counterfactual.horizon_s" in lines[0], lines
assert "nothing in the reference" in reference("no_such_key", code=2).stderr
