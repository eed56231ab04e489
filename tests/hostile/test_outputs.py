# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs never replace what a command reads, a folder, a device, a pipe or a link, and a fit file
writes beside itself or below only. All of it is said before any work begins."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import hostile

a = hostile.parser(__doc__, "db", "vehicles").parse_args()
REFERENCE = "speed_kmh,offset_mm,angle_deg,olc_fe_g\n25,-350,10,8.42\n"
PULSE = "time_s,ax_g\n" + "".join(f"{k / 1000},{-20 if k < 80 else 0}\n" for k in range(150))


def fit(output):
    """One that would take hours."""
    return hostile.fit(output=output, population=100, generations=100000)


def refuse(folder, words, what):
    """Exit code 2 and the reason, soon, and nothing has changed."""
    before, began = hostile.state(folder), time.monotonic()
    result = subprocess.run([a.crashpulse, *words], cwd=folder, capture_output=True, text=True,
                            timeout=60)
    if result.returncode != 2 or what not in result.stderr or result.stdout:
        sys.exit(f"{words}: {result.returncode}\n{result.stdout}{result.stderr}")
    if hostile.state(folder) != before:
        sys.exit(f"{words}: changed {set(hostile.state(folder).items()) ^ set(before.items())}")
    assert time.monotonic() - began < 20, words
    return 1


count = 0
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name) / "work"
    (folder / "sub").mkdir(parents=True)
    shutil.copy(a.db, folder / "study.db")
    shutil.copy(a.vehicles + "/fleet/small_car.yaml", folder / "base.yaml")
    shutil.copy(a.vehicles + "/fleet/suv.yaml", folder / "suv.yaml")
    (folder / "reference.csv").write_text(REFERENCE)
    (folder / "pulse.csv").write_text(PULSE)
    os.link(folder / "study.db", folder / "twin.svg")
    os.symlink("study.db", folder / "link.html")
    os.symlink("/etc", folder / "away")
    os.mkfifo(folder / "pipe.svg")

    # Inputs, by any name.
    read = "is read too"
    count += refuse(folder, ["report", "study.db", "--output", "study.db"], read)
    count += refuse(folder, ["report", "study.db", "--output", "sub/../study.db"], read)
    count += refuse(folder, ["report", "study.db", "--output", "study.db-wal"], read)
    count += refuse(folder, ["report", "link.html", "--output", "study.db"], read)
    count += refuse(folder, ["report", "study.db", "--output", "link.html"], "symbolic link")
    count += refuse(folder, ["plot", "study.db", "olc", "--output", "twin.svg"], read)
    count += refuse(folder, ["crash", "base.yaml", "--speed", "50", "--pulse", "base.yaml"], read)
    count += refuse(folder, ["crash", "base.yaml", "--speed", "50", "--against", "suv.yaml",
                             "--animate", "./suv.yaml"], read)
    count += refuse(folder, ["crash", "base.yaml", "--speed", "50", "--pulse", "x", "--animate",
                             "./x"], "two results")
    count += refuse(folder, ["crash", "--from", "study.db", "--crash", "1", "--pulse", "study.db"],
                    read)
    for own in ("base.yaml", "pulse.csv"):
        count += refuse(folder, ["validate", "base.yaml", "--pulse", "pulse.csv", "--curves", own],
                        read)
    # What is no regular file.
    for output in ("pipe.svg", "/dev/null.svg", "sub"):
        what = {"pipe.svg": "a pipe", "/dev/null.svg": ""}.get(output, ".svg")
        if output != "/dev/null.svg":
            count += refuse(folder, ["plot", "study.db", "olc", "--output", output],
                            what if output != "sub" else "a folder")
    for device in ("/dev/null", "/dev/full", "/dev/stdout"):
        count += refuse(folder, ["report", "study.db", "--output", device], "is not replaced")
        count += refuse(folder, ["crash", "base.yaml", "--speed", "50", "--pulse", device],
                        "is not replaced")

    # A fit file's own output.
    for output, what in (("reference.csv", "must end in .yaml"), ("bashrc", "must end in .yaml"),
                         ("base.yaml", read), ("./sub/../base.yaml", "must be a file beside"),
                         ("fit.yaml", read), ("../out.yaml", "must be a file beside"),
                         ("sub/../../out.yaml", "must be a file beside"),
                         ("/tmp/out.yaml", "must be a file beside"),
                         ("away/out.yaml", "leads to /etc"), ("no/out.yaml", "is there"),
                         ('"a\\nb.yaml"', "single line"), ('"\\e[2J.yaml"', "control characters")):
        (folder / "fit.yaml").write_text(fit(output=output))
        count += refuse(folder, ["calibrate", "fit.yaml"], what)
    (folder / "fit.yaml").write_text(fit(output="out.yaml"))
    count += refuse(folder, ["calibrate", "fit.yaml", "--output", "base.yaml"], read)
    count += refuse(folder, ["calibrate", "fit.yaml", "--output", "x.csv"], "must end in .yaml")
    (folder / "fit.yaml").write_text(fit(output="out.yaml").replace("fit: t", 'fit: "t\\nx: y"'))
    count += refuse(folder, ["calibrate", "fit.yaml"], "single line")

    # Nobody can have put the temporary file there: what used to be its name leads elsewhere.
    victim = folder / "victim"
    victim.write_text("kept")
    for old in ("new.svg.part", "new.html.part"):
        os.symlink("victim", folder / old)
    for words in (["plot", "study.db", "olc", "--output", "new.svg"],
                  ["report", "study.db", "--output", "new.html"]):
        subprocess.run([a.crashpulse, *words], cwd=folder, check=True, capture_output=True)
    assert victim.read_text() == "kept"
    assert not [p for p in folder.iterdir() if p.name.endswith(".part") and not p.is_symlink()]
print(f"{count} outputs refused, nothing changed")
