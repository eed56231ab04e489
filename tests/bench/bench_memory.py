#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""bench_memory.py BUILD SOURCE --seconds S [--periods N] [--output FILE]: memory over simulated time.

The town, or another scenario, with the driver errors of its study and detection in a worker of 'crashpulse
run', and the same configuration, with the same SUMO options, in plain 'sumo' and in an empty libsumo loop,
side by side. In each of N equal periods of simulated time: vehicles on the road, and the median resident set,
with what of it is anonymous, that is the process's own; the rest are pages of program and library files,
which processes share. The peak includes the surrogate's crashes and the database at the end.

SUMO's summary output, written by all three, tells how far a process is. Exit status 1 when one of the --bars is
missed: "peak", of the worker / plain sumo's, for traffic of a size where libraries are not all there is; and
"growth" of the worker from the first period to the last, for traffic that does not grow itself."""
import argparse
import collections
import os
import pathlib
import re
import shlex
import sqlite3
import subprocess
import sys
import tempfile
import time

from plain_sumo import WITHOUT_SCHEMAS
from process_memory import largest_of

PEAK_BAR = 1.3     # worker's peak of resident memory / plain sumo's
GROWTH_BAR = 0.05  # of resident memory, last period to first: 1 MB in 20
WORKER = "crashpulse-wor"
environment = {**os.environ, "SUMO_HOME": "/usr/share/sumo"}
Sample = collections.namedtuple("Sample", "time_s vehicles resident_mb anonymous_mb")


def study(seconds):
    """The scenario's own study: its driver errors, no function, one replication."""
    name = arguments.scenario
    folder = arguments.build / "sumo_scenarios" / name
    text = (folder / "study.yaml").read_text()
    scenarios = text[text.index("scenarios:"):text.index("variants:")].replace(
        f"sumocfg: {name}.sumocfg",
        f"sumocfg: {folder}/{name}.sumocfg\n"
        f"    sumo_options: [--scale, '{arguments.scale}', --summary-output, summary.xml, "
        "--summary-output.period, "
        f"'{max(arguments.step, arguments.seconds / 6000):g}']")
    return (f"study: memory\ndesign: independent\nseed: 20261122\nreplications: 1\nduration_s: {seconds}\n"
            f"step_length_s: {arguments.step}\nbackground: {{duration_s: 0}}\n{scenarios}variants:\n  - name: baseline\n"
            "vehicles:\n  default: mid_size\n")


class Program:
    """A running simulation that writes a summary of its steps, looked at now and then."""

    def __init__(self, label, folder, words):
        self.label, self.folder = label, folder
        self.samples, self.peak_mb = [], 0.0
        self.errors = open(folder / "errors.txt", "w+")
        self.process = subprocess.Popen([str(word) for word in words], cwd=folder, env=environment,
                                        stdout=subprocess.DEVNULL, stderr=self.errors)

    def progress(self):
        """Simulated time and vehicles on the road, as last written."""
        for path in self.folder.glob("*_baseline_*summary.xml"):  # not of the probe before it
            with open(path, "rb") as file:
                file.seek(max(0, path.stat().st_size - 4096))
                steps = re.findall(rb'<step time="([\d.]+)"[^>]* running="(\d+)"', file.read())
            if steps:
                return float(steps[-1][0]), int(steps[-1][1])
        return 0.0, 0

    def look(self):
        """One sample; false when it has ended."""
        if self.process.poll() is not None:
            return False
        memory = largest_of(self.process.pid, WORKER if self.label == "worker" else "")
        self.samples.append(Sample(*self.progress(), memory.resident_mb, memory.anonymous_mb))
        self.peak_mb = max(self.peak_mb, memory.peak_mb)
        return True

    def conclude(self):
        if self.process.returncode != 0:
            self.errors.seek(0)
            sys.exit(f"{self.label}: exit code {self.process.returncode}\n{self.errors.read()[-2000:]}")

    def period(self, number):
        """The sample with the median resident set of a period of time."""
        length = arguments.seconds / arguments.periods
        inside = [s for s in self.samples if s.time_s and
                  min(int(s.time_s / length), arguments.periods - 1) == number]
        if not inside:
            sys.exit(f"{self.label}: no sample in period {number + 1}, too short a run")
        return sorted(inside, key=lambda s: s.resident_mb)[len(inside) // 2]


def run_all(folder):
    """The three programs at the same time. SUMO's options are those of a short run of ours."""
    (folder / "short").mkdir()
    (folder / "short/study.yaml").write_text(study(1))
    run = [arguments.build / "crashpulse", "run", "study.yaml", "--db", "study.db", "--jobs", "1",
           "--allow-sumo-outputs"]  # the summary lies beside the study, not beside the .sumocfg
    subprocess.run(run, cwd=folder / "short", check=True, env=environment, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    words = shlex.split(sqlite3.connect(folder / "short/study.db").execute(
        "SELECT sumo_command_line FROM replication").fetchone()[0])
    steps = round(arguments.seconds / arguments.step)
    every = {"sumo": ["sumo"] + words[1:] + WITHOUT_SCHEMAS + ["--end", arguments.seconds],
             "empty libsumo loop": [arguments.build / "bench_empty_loop", steps] + words,
             "worker": run}
    programs = []
    if arguments.without_loop:
        del every["empty libsumo loop"]
    for label, command in every.items():
        (folder / label).mkdir()
        (folder / label / "study.yaml").write_text(study(arguments.seconds))
        programs.append(Program(label, folder / label, command))
    while sum([program.look() for program in programs]):
        time.sleep(arguments.interval)
    for program in programs:
        program.conclude()
    crashes = sqlite3.connect(folder / "worker/study.db").execute("SELECT count(*) FROM crash").fetchone()[0]
    return programs, crashes


def growth_of(program):
    """Of resident memory, from the first period to the last."""
    return program.period(arguments.periods - 1).resident_mb / program.period(0).resident_mb - 1


def report(programs, crashes):
    minutes = arguments.seconds / arguments.periods / 60
    lines = [f"| from minute | " + " | ".join(f"{p.label}: vehicles | resident MB | anonymous MB"
                                              for p in programs) + " |",
             "|---:" * (1 + 3 * len(programs)) + "|"]
    for number in range(arguments.periods):
        cells = [f"{number * minutes:g}"]
        for program in programs:
            sample = program.period(number)
            cells += [f"{sample.vehicles}", f"{sample.resident_mb:.1f}", f"{sample.anonymous_mb:.1f}"]
        lines.append("| " + " | ".join(cells) + " |")
    growth = growth_of(programs[-1])
    ratio = programs[-1].peak_mb / programs[0].peak_mb
    peak_bar = f", bar {PEAK_BAR}" if "peak" in arguments.bars else ""
    growth_bar = f", bar {100 * GROWTH_BAR:.0f} %" if "growth" in arguments.bars else ""
    lines += ["", "Peak of resident memory: " +
              ", ".join(f"{p.label} {p.peak_mb:.1f} MB" for p in programs) +
              f". The worker's over plain sumo's: {ratio:.2f}{peak_bar}.",
              f"Growth from the first period to the last: worker {100 * growth:+.1f} %{growth_bar}, plain sumo "
              f"{100 * growth_of(programs[0]):+.1f} %; the worker found {crashes} crashes."]
    is_missed = (peak_bar and ratio > PEAK_BAR) or (growth_bar and growth > GROWTH_BAR)
    return "\n".join(lines) + "\n", not is_missed


parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
parser.add_argument("build", type=lambda text: pathlib.Path(text).resolve())
parser.add_argument("source", type=lambda text: pathlib.Path(text).resolve())
parser.add_argument("--scenario", default="town", help="of sumo_scenarios")
parser.add_argument("--scale", type=float, default=1.0, help="of the demand")
parser.add_argument("--seconds", type=int, required=True)
parser.add_argument("--step", type=float, default=0.1, help="step length, s")
parser.add_argument("--without-loop", action="store_true", help="no empty libsumo loop")
parser.add_argument("--periods", type=int, default=10)
parser.add_argument("--interval", type=float, default=1.0, help="between two samples, s")
parser.add_argument("--bars", choices=["peak", "growth"], nargs="+", default=["peak", "growth"])
parser.add_argument("--output")
arguments = parser.parse_args()
if "peak" not in arguments.bars:
    # Growth alone is seen in small pages: huge ones come 2 MB at a time, now in one period, now in another.
    environment["GLIBC_TUNABLES"] = "glibc.malloc.hugetlb=0"
with tempfile.TemporaryDirectory() as name:
    text, is_good = report(*run_all(pathlib.Path(name)))
print(text)
if arguments.output:
    pathlib.Path(arguments.output).write_text(
        "# Memory over ten simulated hours of the town\n\nMade by `cmake --build build --target "
        f"town_ten_hours` (step {arguments.step:g} s, demand × {arguments.scale:g}).\n" +
        __doc__.split("\n\n")[1] + "\n\n" + text)
sys.exit(0 if is_good else 1)
