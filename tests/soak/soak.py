# SPDX-License-Identifier: GPL-3.0-or-later
"""soak.py BUILD SOURCE --hours N [--output FILE]: the town for N simulated hours, twice at the same time.

Two workers of one 'crashpulse run': the driver errors of the town's study with the cars as they are, and with all
driver assistance functions. Good when memory of workers and runner is flat (resident set of the last period at
most 5 % above that of the second; the first is the town filling), no replication failed but by a fault that
SUMO names, 'crashpulse check' and SQLite's integrity check find nothing, and the database holds what the
workers counted. SUMO's summary output tells how far a worker is."""
import argparse
import collections
import os
import pathlib
import re
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "bench"))
from process_memory import family_of, memory_of

GROWTH_BAR = 0.05
WORKER = "crashpulse-wor"
SUMO_FAULT = re.compile(r"SUMO stopped|Quitting \(on error\)")  # as SUMO itself says what is wrong
STUDY = """study: soak
design: paired_seeds
seed: {seed}
replications: 1
duration_s: {seconds}
step_length_s: {step}
background: {{duration_s: 0}}
{scenarios}variants:
  - name: baseline
  - name: functions
    functions: [{{function: aeb}}, {{function: fcw}}, {{function: elk}}, {{function: isa}}]
vehicles:
  default: {vehicles}/honda_accord_2014.yaml
  types:
    - {{type: small_car, model: {vehicles}/fleet/small_car.yaml}}
    - {{type: mid_size_car, model: {vehicles}/mid_size.yaml}}
    - {{type: suv, model: {vehicles}/suv.yaml}}
    - {{type: van, model: {vehicles}/van.yaml}}
"""
VARIANTS = ("baseline", "functions")
Sample = collections.namedtuple("Sample", "time_s vehicles resident_mb anonymous_mb")


def write_study(folder):
    town = arguments.build / "sumo_scenarios" / "town"
    text = (town / "study.yaml").read_text()
    every_s = max(arguments.step, arguments.hours * 3600 / 20000)
    scenarios = text[text.index("scenarios:"):text.index("variants:")].replace(
        "sumocfg: town.sumocfg",
        f"sumocfg: {town}/town.sumocfg\n"
        f"    sumo_options: [--scale, '{arguments.scale}', --summary-output, summary.xml, "
        f"--summary-output.period, '{every_s:g}']")
    (folder / "study.yaml").write_text(STUDY.format(
        seed=arguments.seed, seconds=round(arguments.hours * 3600), step=arguments.step,
        scenarios=scenarios, vehicles=arguments.source / "db" / "vehicles"))


def progress(folder, variant):
    """Simulated time and vehicles on the road, as SUMO last wrote them."""
    for path in folder.glob(f"*_{variant}_*summary.xml"):
        with open(path, "rb") as file:
            file.seek(max(0, path.stat().st_size - 4096))
            steps = re.findall(rb'<step time="([\d.]+)"[^>]* running="(\d+)"', file.read())
        if steps:
            return float(steps[-1][0]), int(steps[-1][1])
    return 0.0, 0


def variant_of(folder, process):
    """Of the replication that a worker runs; None when it only tries whether SUMO starts."""
    try:
        words = pathlib.Path(f"/proc/{process}/cmdline").read_bytes().split(b"\0")
        row = words[words.index(b"--replication") + 1]
    except (OSError, ValueError):
        return None
    with sqlite3.connect(f"file:{folder}/study.db?mode=ro", uri=True, timeout=60) as connection:
        found = connection.execute("SELECT v.name FROM replication AS r JOIN variant AS v ON v.id = "
                                   "r.variant_id WHERE r.id = ?", (int(row),)).fetchone()
    connection.close()
    return found[0] if found else None


def watch(folder, runner):
    """Samples of both workers and of the runner, until it ends."""
    samples = {name: [] for name in (*VARIANTS, "runner")}
    variants = {}
    while runner.poll() is None:
        for process in family_of(runner.pid):
            memory = memory_of(process, WORKER)
            if process == runner.pid:
                memory = memory_of(process)
                times = [progress(folder, v)[0] for v in VARIANTS]
                samples["runner"].append(Sample(min(times), 0, memory.resident_mb, memory.anonymous_mb))
            elif memory.resident_mb > 0:
                if variants.get(process) is None:
                    variants[process] = variant_of(folder, process)
                if variants[process] in VARIANTS:
                    samples[variants[process]].append(Sample(
                        *progress(folder, variants[process]), memory.resident_mb, memory.anonymous_mb))
        time.sleep(arguments.interval)
        if arguments.minutes and time.monotonic() - started_s > 60 * arguments.minutes:
            runner.terminate()
            runner.wait()
            print(f"WRONG: stopped after {arguments.minutes:g} minutes of real time")
    return samples


def by_period(samples):
    """Median sample of each period."""
    length_s = 60 * arguments.period_minutes
    periods = collections.defaultdict(list)
    for sample in samples:
        periods[int(sample.time_s / length_s)].append(sample)
    return {number: Sample(*(statistics.median(values) for values in zip(*found)))
            for number, found in sorted(periods.items())}


def judge_memory(samples):
    """A table, and what grew too much."""
    lines = ["| from minute | process | vehicles | resident MB | anonymous MB |", "|---:|---|---:|---:|---:|"]
    wrong = []
    for name, found in samples.items():
        periods = by_period(found)
        for number, sample in periods.items():
            lines.append(f"| {number * arguments.period_minutes:g} | {name} | {sample.vehicles:.0f} | "
                         f"{sample.resident_mb:.1f} | {sample.anonymous_mb:.1f} |")
        # The last period against the one after the first.
        last = max(periods, default=0)
        if 1 not in periods or last <= 1:
            wrong.append(f"{name}: too short a run for its memory")
            continue
        growth = periods[last].resident_mb / periods[1].resident_mb - 1
        lines.append(f"| {name}: {100 * growth:+.1f} % from the second to the last period, bar "
                     f"{100 * GROWTH_BAR:.0f} % | | | | |")
        if growth > GROWTH_BAR:
            wrong.append(f"{name}: resident memory grew by {100 * growth:.1f} %")
    return lines, wrong


def judge_database(folder, code, errors):
    """What the run ended with, and what is wrong with it."""
    wrong = []
    connection = sqlite3.connect(folder / "study.db")
    one = lambda sql: connection.execute(sql).fetchone()[0]
    failures = connection.execute("SELECT message FROM attempt WHERE outcome <> 'done'").fetchall()
    unnamed = [text for (text,) in failures if not SUMO_FAULT.search(text or "")]
    if unnamed or (code != 0) != bool(failures):
        wrong.append(f"exit code {code}, failures: {unnamed}; {errors[-1000:]}")
    if connection.execute("PRAGMA integrity_check").fetchall() != [("ok",)]:
        wrong.append("SQLite's integrity check")
    check = subprocess.run([arguments.build / "crashpulse", "check", folder / "study.db"],
                           capture_output=True, text=True)
    if check.returncode != 0:
        wrong.append(f"crashpulse check: {check.stdout}{check.stderr}")
    done = one("SELECT count(*) FROM replication WHERE status = 'done'")
    hours = one("SELECT sum(simulated_s) FROM replication WHERE status = 'done'") or 0
    crashes = one("SELECT count(*) FROM crash")
    if done + len(failures) < len(VARIANTS) or (done and crashes == 0):
        wrong.append(f"{done} replications done, {crashes} crashes")
    lines = [f"{done} of {one('SELECT count(*) FROM replication')} replications done, {hours / 3600:.1f} "
             f"simulated hours, {one('SELECT sum(vehicle_km) FROM replication') or 0:.0f} vehicle-km, "
             f"{crashes} crashes, {one('SELECT count(*) FROM pulse')} pulses, {len(failures)} attempts "
             f"failed; integrity check and 'crashpulse check': {'good' if not wrong else 'see below'}."]
    connection.close()
    return lines, wrong


parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
parser.add_argument("build", type=lambda text: pathlib.Path(text).resolve())
parser.add_argument("source", type=lambda text: pathlib.Path(text).resolve())
parser.add_argument("--hours", type=float, default=24, help="simulated, of each worker")
parser.add_argument("--step", type=float, default=0.2, help="step length, s")
parser.add_argument("--scale", type=float, default=0.5, help="of the demand: half of it flows without jams")
parser.add_argument("--seed", type=int, default=20261130)
parser.add_argument("--period-minutes", type=float, default=60, help="simulated, of the table")
parser.add_argument("--interval", type=float, default=5.0, help="between two samples, s")
parser.add_argument("--minutes", type=float, help="of real time at most")
parser.add_argument("--output")
arguments = parser.parse_args()
started_s = time.monotonic()
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    write_study(folder)
    with open(folder / "errors.txt", "w+") as errors:
        runner = subprocess.Popen([arguments.build / "crashpulse", "run", "study.yaml", "--db", "study.db", "--allow-sumo-outputs",
                                   "--jobs", "2"], cwd=folder, stdout=subprocess.DEVNULL, stderr=errors,
                                  env={**os.environ, "SUMO_HOME": "/usr/share/sumo"})
        samples = watch(folder, runner)
        errors.seek(0)
        said = errors.read()
    lines, wrong = judge_memory(samples)
    more, also_wrong = judge_database(folder, runner.returncode, said)
text = "\n".join([*lines, "", *more, f"{(time.monotonic() - started_s) / 60:.0f} minutes of real time.",
                  *(f"WRONG: {w}" for w in wrong + also_wrong), ""])
print(text)
if arguments.output:
    pathlib.Path(arguments.output).write_text(
        f"# {arguments.hours:g} simulated hours of the town\n\nMade by `cmake --build build --target soak` "
        f"({arguments.hours:g} h by each worker, step {arguments.step:g} s, demand × {arguments.scale:g}).\n" +
        __doc__.split("\n\n")[1] + "\n\n" + text)
sys.exit(1 if wrong or also_wrong else 0)
