#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""bench_traffic.py BUILD SOURCE PYTHON [REPEATS]: what a step of the town costs beside SUMO itself.

The same traffic, with the same SUMO options, in four programs: plain 'sumo', an empty libsumo loop in
C++, 'crashpulse run' with detection on and no driver error or function, and a Python libsumo script
that reads all states and looks for overlapping pairs (with PYTHON, Debian's, which has libsumo; left
out where it has none). Processor time, user and system, of the steps between SHORT and LONG simulated
seconds: that of the long run less that of the short one, so that starting up costs nothing.
Interleaved; per program the least of all repeats. Beside it the peak of resident memory in the long
run, of the largest process. Exit status 1 when a bar is missed."""
import os
import pathlib
import shlex
import sqlite3
import subprocess
import sys
import tempfile

build, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
python = sys.argv[3]
repeats = int(sys.argv[4]) if len(sys.argv) > 4 else 5
SHORT_S, LONG_S, STEP_S = 150, 250, 0.1  # --scale 2: 0.8 to 1.3 thousand vehicles
LOOP_BAR, PYTHON_BAR, MEMORY_BAR = 1.20, 0.2, 1.3
peak_mb = {}  # by program, of its last run
environment = {**os.environ, "SUMO_HOME": "/usr/share/sumo"}


def cpu_s(label, words):
    """Processor time of a program and of those it started."""
    process = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, env=environment)
    errors = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{words[0]}: exit code {process.returncode}\n{errors.decode()}")
    peak_mb[label] = used.ru_maxrss / 1024
    return used.ru_utime + used.ru_stime


def study(folder, duration_s):
    path = folder / f"{duration_s}.yaml"
    path.write_text(
        f"study: bench\ndesign: independent\nseed: 1\nreplications: 1\nduration_s: {duration_s}\n"
        f"step_length_s: {STEP_S}\nscenarios:\n  - name: town\n"
        f"    sumocfg: {source}/sumo_scenarios/town/town.sumocfg\n"
        "    sumo_options: [--scale, '2']\nvariants:\n  - name: baseline\n"
        "vehicles:\n  default: mid_size\n")
    return path


def run_crashpulse(folder, duration_s):
    for old in folder.glob(f"{duration_s}.db*"):
        old.unlink()
    return cpu_s("crashpulse run", [build / "crashpulse", "run", study(folder, duration_s), "--db",
                  folder / f"{duration_s}.db", "--jobs", "1"])


def exposure(folder, duration_s):
    return sqlite3.connect(folder / f"{duration_s}.db").execute(
        "SELECT vehicle_h, sumo_command_line FROM replication").fetchone()


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    # SUMO's options of our run, for the others.
    run_crashpulse(folder, SHORT_S)
    run_crashpulse(folder, LONG_S)
    hours = [exposure(folder, duration_s)[0] for duration_s in (SHORT_S, LONG_S)]
    words = shlex.split(exposure(folder, LONG_S)[1])
    programs = {
        "sumo": lambda s: cpu_s("sumo", ["sumo"] + words[1:] + ["--end", s]),
        "empty libsumo loop": lambda s: cpu_s(
            "empty libsumo loop", [build / "bench_empty_loop", round(s / STEP_S)] + words),
        "crashpulse run": lambda s: run_crashpulse(folder, s),
        "Python libsumo script": lambda s: cpu_s(
            "Python libsumo script",
            [python, pathlib.Path(__file__).parent / "bench_python_loop.py", round(s / STEP_S)] + words),
    }
    if subprocess.run([python, "-c", "import libsumo"], stderr=subprocess.DEVNULL).returncode != 0:
        print(f"{python} has no libsumo: without the Python script")
        del programs["Python libsumo script"]
    least = {label: {} for label in programs}
    for repeat in range(repeats):
        for duration_s in (SHORT_S, LONG_S):
            for label, program in programs.items():
                used = program(duration_s)
                least[label][duration_s] = min(used, least[label].get(duration_s, used))
        print(f"repeat {repeat + 1} of {repeats}", file=sys.stderr, flush=True)

steps = (LONG_S - SHORT_S) / STEP_S
cost = {label: (used[LONG_S] - used[SHORT_S]) / steps * 1e3 for label, used in least.items()}
loop = cost["empty libsumo loop"]
print(f"town, {(hours[1] - hours[0]) * 3600 / (LONG_S - SHORT_S):.0f} vehicles at once on average, "
      f"steps of {STEP_S} s, {steps:.0f} of them, least of {repeats}")
print(f"{'':24}{'ms a step':>10}{'of the loop':>13}{'overhead ms':>13}{'peak MB':>9}")
for label, value in cost.items():
    print(f"{label:24}{value:10.3f}{value / loop:13.3f}{value - loop:13.3f}{peak_mb[label]:9.0f}")
ours = cost["crashpulse run"]
print(f"crashpulse run / empty loop: {ours / loop:.3f}, bar {LOOP_BAR}")
missed = ours / loop > LOOP_BAR
if "Python libsumo script" in cost:
    share = (ours - loop) / (cost["Python libsumo script"] - loop)
    print(f"its overhead / the Python script's: {share:.3f}, bar {PYTHON_BAR}")
    missed |= share > PYTHON_BAR
memory = peak_mb["crashpulse run"] / peak_mb["sumo"]
print(f"its peak of memory / plain sumo's: {memory:.2f}, bar {MEMORY_BAR}")
missed |= memory > MEMORY_BAR
sys.exit(1 if missed else 0)
