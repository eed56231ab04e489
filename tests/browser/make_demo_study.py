#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's study, shorter, run on real SUMO traffic: make_demo_study.py CRASHPULSE STUDY.yaml OUTPUT.db"""
import pathlib
import re
import subprocess
import sys
import tempfile

crashpulse, study, output = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
text = study.read_text(encoding="utf-8")
for key, value in (("replications", "2"), ("duration_s", "300")):
    text, found = re.subn(rf"(?m)^{key}: .*$", f"{key}: {value}", text)
    assert found == 1, f"{study} has no {key}"
# Files are named from the study's own folder.
text = re.sub(r"(?m)((?:sumocfg|default): )(\.\./\S+)", lambda m: m[1] + str((study.parent / m[2]).resolve()), text)
output.unlink(missing_ok=True)
with tempfile.TemporaryDirectory() as folder:
    short = pathlib.Path(folder) / "study.yaml"
    short.write_text(text, encoding="utf-8")
    subprocess.run([crashpulse, "run", short, "--db", output], check=True)
