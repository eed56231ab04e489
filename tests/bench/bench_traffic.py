#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""bench_traffic.py BUILD SOURCE PYTHON OUTPUT [REPEATS]: what a step of the town costs beside SUMO itself.

The same traffic, with the same SUMO options, in four programs: plain 'sumo', an empty libsumo loop in
C++, 'crashpulse run' with detection on and no driver error or function, and a Python libsumo script
that reads all states and looks for overlapping pairs (with PYTHON, Debian's, which has libsumo; left
out where it has none). Beside them 'crashpulse run' with all driver errors of the town's own study and
AEB in every car, whose traffic is another as soon as they brake or crash: for information. Processor
time of the steps between SHORT and LONG simulated seconds. The
programs run one after the other, REPEATS times (the Python script twice); every one writes its
processor time each second of traffic (step_clock.cpp), and of every such second counts the least of all
repeats: what a neighbour takes of a machine for a while does not last for all repeats of a second.
Plain sumo cannot be looked into so; it counts as a whole, the least long run less the least short one.
Beside it the peak of resident memory in one more long run, of ours the worker's, and what of it is
anonymous, the process's own: the rest are pages of program and library files, which processes share.
The table goes to OUTPUT too. Exit status 1 when a bar is missed."""
import os
import pathlib
import re
import shlex
import sqlite3
import subprocess
import sys
import tempfile
import threading

from plain_sumo import WITHOUT_SCHEMAS
from process_memory import largest_of

build, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
python, output = sys.argv[3:5]
repeats = int(sys.argv[5]) if len(sys.argv) > 5 else 9
SHORT_S, LONG_S, STEP_S = 150, 250, 0.1  # --scale 2: 0.8 to 1.3 thousand vehicles
STRETCH_STEPS = 10
LOOP_BAR, PYTHON_BAR, MEMORY_BAR = 1.20, 0.2, 1.3
FULL = "crashpulse run, driver errors and AEB"
LOOK_S = 0.05  # between two looks at a program's memory
environment = {**os.environ, "SUMO_HOME": "/usr/share/sumo", "STEP_CLOCK": os.devnull,
               "STEP_CLOCK_EVERY": str(STRETCH_STEPS)}


def start(words, **extra):
    return subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, env={**environment, **extra})


def wait(process):
    """Processor time of a program and of those it started."""
    errors = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{process.args[0]}: exit code {process.returncode}\n{errors.decode()}")
    return used.ru_utime + used.ru_stime


def cpu_s(words):
    return wait(start(words))


def stretches_s(words, clock):
    """Processor time of every stretch of steps between SHORT and LONG. Python has libsumo in itself."""
    preload = {} if words[0] == python else {"LD_PRELOAD": str(build / "step_clock.so")}
    wait(start(words, **preload, STEP_CLOCK=str(clock)))
    times = [float(line) for line in clock.read_text().split()]
    first, last = (round(s / STEP_S / STRETCH_STEPS) for s in (SHORT_S, LONG_S))
    if len(times) <= last:
        sys.exit(f"{words[0]}: clock of {len(times)} stretches, {last + 1} needed")
    return [after - before for before, after in zip(times[first:last], times[first + 1:last + 1])]


def peak_of(words, name):
    """A run of its own, looked at all the time: memory when most was resident, of its program NAME."""
    samples, is_over = [], threading.Event()
    process = start(words)

    def look():
        while not is_over.wait(LOOK_S):
            samples.append(largest_of(process.pid, name))

    watcher = threading.Thread(target=look, daemon=True)
    watcher.start()
    wait(process)
    is_over.set()
    watcher.join()
    return max(samples)._replace(peak_mb=max(sample.peak_mb for sample in samples))


def study(folder, duration_s, is_full):
    path = folder / f"{duration_s}.yaml"
    town = (build / "sumo_scenarios/town/study.yaml").read_text()
    errors = re.search(r"^    driver_errors:.*?(?=^\S)", town, re.MULTILINE | re.DOTALL).group()
    path.write_text(
        f"study: bench\ndesign: independent\nseed: 1\nreplications: 1\nduration_s: {duration_s}\n"
        f"step_length_s: {STEP_S}\nscenarios:\n  - name: town\n"
        f"    sumocfg: {build}/sumo_scenarios/town/town.sumocfg\n"
        "    sumo_options: [--scale, '2']\n" + (errors if is_full else "") +
        "variants:\n  - name: baseline\n" + ("    functions: [{function: aeb}]\n" if is_full else "") +
        "vehicles:\n  default: mid_size\nbackground: {duration_s: 0}\n")
    return path


def crashpulse_words(folder, duration_s, is_full=False):
    """A run of ours into a new database."""
    for old in folder.glob(f"{duration_s}.db*"):
        old.unlink()
    return [build / "crashpulse", "run", study(folder, duration_s, is_full), "--db",
            folder / f"{duration_s}.db", "--jobs", "1"]


def exposure(folder, duration_s):
    return sqlite3.connect(folder / f"{duration_s}.db").execute(
        "SELECT vehicle_h, sumo_command_line FROM replication").fetchone()


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    # SUMO's options of our run, for the others.
    for duration_s in (SHORT_S, LONG_S):
        cpu_s(crashpulse_words(folder, duration_s))
    hours = [exposure(folder, duration_s)[0] for duration_s in (SHORT_S, LONG_S)]
    words = shlex.split(exposure(folder, LONG_S)[1])
    here = pathlib.Path(__file__).parent
    programs = {
        "sumo": lambda s: ["sumo"] + words[1:] + WITHOUT_SCHEMAS + ["--end", s],
        "empty libsumo loop": lambda s: [build / "bench_empty_loop", round(s / STEP_S)] + words,
        "crashpulse run": lambda s: crashpulse_words(folder, s),
        FULL: lambda s: crashpulse_words(folder, s, is_full=True),
        "Python libsumo script": lambda s: [python, here / "bench_python_loop.py",
                                            round(s / STEP_S)] + words,
    }
    if subprocess.run([python, "-c", "import libsumo"], stderr=subprocess.DEVNULL).returncode != 0:
        print(f"{python} has no libsumo: without the Python script")
        del programs["Python libsumo script"]
    end_s = LONG_S + STRETCH_STEPS * STEP_S  # the last stretch needs a clock at its end
    sumo_s = {SHORT_S: [], LONG_S: []}
    runs = {label: [] for label in programs if label != "sumo"}
    for repeat in range(repeats):
        for duration_s, found in sumo_s.items():
            found.append(cpu_s(programs["sumo"](duration_s)))
        for label, found in runs.items():
            if label != "Python libsumo script" or repeat < 2:
                found.append(stretches_s(programs[label](end_s), folder / "clock"))
        print(f"repeat {repeat + 1} of {repeats}", file=sys.stderr, flush=True)
    peak = {label: peak_of(program(LONG_S), "crashpulse-wor" if label.startswith("crashpulse") else "")
            for label, program in programs.items()}
    # What a user sees who runs the configuration by himself: no random numbers of its own for every lane.
    alone = peak_of(["sumo", "-c", words[words.index("-c") + 1], "--scale", "2", "--step-length", STEP_S,
                     "--no-step-log", "true", "--end", LONG_S] + WITHOUT_SCHEMAS, "")

steps = (LONG_S - SHORT_S) / STEP_S
cost = {"sumo": (min(sumo_s[LONG_S]) - min(sumo_s[SHORT_S])) / steps * 1e3}
cost |= {label: sum(map(min, zip(*found))) / steps * 1e3 for label, found in runs.items()}
loop = cost["empty libsumo loop"]
lines = [f"The town with {(hours[1] - hours[0]) * 3600 / (LONG_S - SHORT_S):.0f} vehicles at once on average, "
         f"steps of {STEP_S} s, {steps:.0f} of them, of every {STRETCH_STEPS} the least of {repeats} runs.", "",
         "| | ms a step | of the loop | overhead, ms | peak, MB | of it anonymous | of sumo's peak |",
         "|---|---:|---:|---:|---:|---:|---:|"]
for label, value in cost.items():
    lines.append(f"| {label} | {value:.3f} | {value / loop:.3f} | {value - loop:.3f} | "
                 f"{peak[label].peak_mb:.1f} | {peak[label].anonymous_mb:.1f} | "
                 f"{peak[label].peak_mb / peak['sumo'].peak_mb:.2f} |")
lines.append("")
ours = cost["crashpulse run"]
is_missed = False


def hold(what, value, bar):
    global is_missed
    is_missed |= value > bar
    lines.append(f"* {what}: {value:.3f}, bar {bar}: {'MISSED' if value > bar else 'kept'}")


hold("crashpulse run / empty loop", ours / loop, LOOP_BAR)
if "Python libsumo script" in cost:
    hold("its overhead / the Python script's", (ours - loop) / (cost["Python libsumo script"] - loop),
         PYTHON_BAR)
hold("its peak of resident memory / plain sumo's", peak["crashpulse run"].peak_mb / peak["sumo"].peak_mb,
     MEMORY_BAR)
lines.append(f"* without our options plain sumo takes {alone.peak_mb:.1f} MB: "
             f"{peak['crashpulse run'].peak_mb / alone.peak_mb:.2f} of that")
text = "\n".join(lines) + "\n"
print(text)
pathlib.Path(output).write_text(
    "# What a step of traffic costs\n\nMade by `cmake --build build --target bench_traffic`. "
    "The same traffic, with the same SUMO options, in plain\n`sumo`, in an empty libsumo loop in C++, in "
    "`crashpulse run` with detection on and no driver error or\nfunction, and in a Python libsumo script "
    "that reads all states and looks for overlapping pairs. Beside\nthem `crashpulse run` with all driver errors of "
    "the town's study and AEB in every car, whose traffic is another as\nsoon as somebody brakes. Processor\ntime of the steps alone, interleaved. "
    "Memory is that of the process that simulates; what is not anonymous are\npages of program and library files, "
    "which processes share.\n\n" + text)
sys.exit(1 if is_missed else 0)
