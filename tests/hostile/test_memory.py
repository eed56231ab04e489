# SPDX-License-Identifier: GPL-3.0-or-later
"""Every request for memory is refused in turn, one a run of a command. Either the command does not
need it, and gives what it gives otherwise, or it ends with a message and exit code 1; it never gives
another number, half a file or a row of a database that is not the right one. --samples N: about N
requests a command instead of all. --per-path N: of the requests that the same calls lead to (the innermost
--depth of them), N spread over all, the first among them: most of a command's hundred thousands are such
repetitions."""
import array
import collections
import concurrent.futures
import hashlib
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

import hostile

STUDY = hostile.study(12, more="background: {duration_s: 5}\n", scenario="""\
    driver_errors:
      - {model: failed_to_see, parameters: {probability_1: 1}}
""", variants="  - {name: aeb, functions: [{function: aeb}]}\n")
FIT = (hostile.fit(base="small_car.yaml", output="fitted.yaml")
       + "  - {name: corner_gap_m, min: 0.05, max: 0.7}\n")
REFERENCE = "speed_kmh,offset_mm,angle_deg,olc_fe_g\n56,0,0,23.9\n40,0,0,15.0\n25,0,0,9.0\n"

parser = hostile.parser(__doc__, "db", "network", "vehicles", "samples")  # samples of each command
parser.add_argument("--shim", required=True, help="failing_memory.so")
parser.add_argument("--per-path", type=int, default=0, help="of the requests that the same calls lead to")
parser.add_argument("--depth", type=int, default=10, help="calls that make a path")
parser.add_argument("--jobs", type=int, default=2)
parser.add_argument("--only", action="append", help="this command only")
a = parser.parse_args()

CAR, SUV = a.vehicles + "/honda_accord_2014.yaml", a.vehicles + "/fleet/suv.yaml"
# Name: words; share of the samples; in which program.
COMMANDS = {
    "crash": (["crash", CAR, "--speed", "56", "--format", "json"], 1, "crashpulse"),
    "crash, car to car": (["crash", CAR, "--against", SUV, "--speed", "56", "--pulse", "p.csv",
                           "--animate", "a.html"], 1, "crashpulse"),
    "crash, samples": (["crash", SUV, "--speed", "56", "--samples", "3"], 1, "crashpulse"),
    "crash, stored": (["crash", "--from", "list.db", "--crash", "CRASH", "--format", "json"], 1,
                      "crashpulse"),
    "compare": (["compare", "study.db", "--format", "json"], 0.5, "crashpulse"),
    "report": (["report", "study.db", "--output", "r.html"], 0.5, "crashpulse"),
    "plot": (["plot", "study.db", "benefit", "--output", "f.svg"], 0.5, "crashpulse"),
    "check": (["check", "list.db", "--format", "csv"], 1, "crashpulse"),
    "status": (["status", "study.db"], 1, "crashpulse"),
    "sql": (["sql", "study.db", "SELECT median(olc_g, censored) FROM frontal_vehicle"], 1,
            "crashpulse"),
    "assess": (["assess", "--configurations", "list.csv", "--format", "csv", "--db", "new.db"], 1,
               "crashpulse"),
    "merge": (["merge", "new.db", "study.db"], 0.5, "crashpulse"),
    "plan": (["plan", "study.yaml"], 1, "crashpulse"),
    "submit": (["submit", "study.yaml", "--slurm", "--db", "x.db", "--dry-run"], 1, "crashpulse"),
    "validate": (["validate", "small_car.yaml", "--reference", "reference.csv"], 1, "crashpulse"),
    "calibrate": (["calibrate", "fit.yaml"], 0.5, "crashpulse"),
    "run": (["run", "study.yaml", "--db", "new.db", "--jobs", "1"], 0.2, "crashpulse"),
    "run, its workers": (["run", "study.yaml", "--db", "new.db", "--jobs", "1"], 0.3,
                         "crashpulse-worker"),
}
# What simulations gave, without what tells when and where.
RESULTS = ("SELECT id, time_s, closing_speed_m_s, lateral_offset_m, angle_rad FROM crash",
           "SELECT crash_id, role, speed_m_s, delta_v_m_s, olc_g, olc_status FROM crash_vehicle",
           "SELECT crash_id, role, samples FROM pulse",
           "SELECT scenario_id, variant_id, number, vehicle_km, departed FROM replication "
           "WHERE status = 'done'")


def rows_of(path):
    connection = sqlite3.connect(path)
    try:
        assert connection.execute("PRAGMA quick_check").fetchall() == [("ok",)], path
        tables = {row[0] for row in connection.execute("SELECT name FROM sqlite_schema")}
        if not {"crash", "crash_vehicle", "pulse", "replication"} <= tables:
            return set()
        return {(k, *row) for k, query in enumerate(RESULTS) for row in connection.execute(query)}
    finally:
        connection.close()


def prepare(folder):
    (folder / "study.yaml").write_text(STUDY)
    (folder / "fit.yaml").write_text(FIT)
    (folder / "list.csv").write_text(hostile.LIST)
    (folder / "reference.csv").write_text(REFERENCE)
    shutil.copy(a.vehicles + "/fleet/small_car.yaml", folder)
    shutil.copytree(a.network, folder / "net")
    shutil.copy(a.db, folder / "study.db")
    subprocess.run([a.crashpulse, "assess", "--configurations", "list.csv", "--db", "list.db"],
                   cwd=folder, check=True, capture_output=True)


def state_of(folder, before):
    """New files by their content, databases by their rows."""
    files = {}
    for path in folder.rglob("*"):
        name = str(path.relative_to(folder))
        # A fit goes on from its state files: they are there to stay after a failure.
        if (not path.is_file() or name in before or name == "count"
                or name.endswith(("-wal", "-shm", ".fit.state"))):
            continue
        files[name] = rows_of(path) if name.endswith(".db") else hashlib.sha256(
            path.read_bytes().replace(bytes(folder), b"")).hexdigest()
    return files


def by_path(files):
    """Numbers of requests to refuse: --per-path of every path of calls, whichever process went it."""
    where = collections.defaultdict(set)
    for path in files:
        for k, value in enumerate(array.array("Q", path.read_bytes()), 1):
            where[value].add(k)
    places = set()
    for found in map(sorted, where.values()):
        few = max(1, a.per_path - 1)
        places.update(found[k * (len(found) - 1) // few] for k in range(a.per_path))
    return sorted(places), len(where)


def run(name, source, at=None, paths=None):
    words, _, program = COMMANDS[name]
    with tempfile.TemporaryDirectory() as text:
        folder = pathlib.Path(text)
        shutil.copytree(source, folder, dirs_exist_ok=True)
        before = hostile.names(folder)
        content = {n: (folder / n).read_bytes() for n in before if (folder / n).is_file()}
        environment = dict(os.environ, LD_PRELOAD=a.shim, COUNT_FILE=str(folder / "count"), FAIL_IN=program)
        if at is not None:
            environment["FAIL_AT"] = str(at)
        if paths is not None:
            environment.update(PATHS_FILE=str(paths / "paths"), PATHS_DEPTH=str(a.depth))
        try:
            # At the same addresses in every process, so that their paths can be told to be the same.
            if paths:
                result = hostile.run("setarch", folder, "-R", a.crashpulse, *words, environment=environment)
            else:
                result = hostile.run(a.crashpulse, folder, *words, environment=environment)
        except subprocess.TimeoutExpired:
            return "no end in 120 s", None, None, None, None
        count = folder / "count"
        number = int(count.read_text()) if count.exists() else 0
        for n, bytes_before in content.items():
            if not n.endswith(".db") and (folder / n).read_bytes() != bytes_before:
                return f"{n} was changed", None, None, None, None
        return (result.returncode, result.stdout, result.stderr.decode(errors="replace"),
                state_of(folder, before), number)


def judge(right, found, program):
    """Nothing, or what is wrong."""
    if isinstance(found[0], str):
        return found[0]
    code, out, err, files, _ = found
    if code == 0:
        if out != right[1]:
            return "exit code 0 with another result"
        other = [name for name in right[3] if files.get(name) != right[3][name]]
        return f"exit code 0 with other files: {other}" if other else None
    # SUMO does not tell want of memory from bad input.
    if code != 1 and not (code == 2 and program != "crashpulse"):
        return f"exit code {code}: {err[-200:]}"
    if not hostile.has_message(err):
        return f"exit code 1 without a message: {err[-200:]}"
    for name, content in files.items():
        same = content <= right[3].get(name, set()) if isinstance(content, set) else (
            content == right[3].get(name))
        if not same:
            return f"left behind: {name}"
    return None


tried, wrong = 0, 0
with tempfile.TemporaryDirectory() as text:
    source = pathlib.Path(text) / "source"
    source.mkdir()
    prepare(source)
    connection = sqlite3.connect(source / "list.db")
    COMMANDS["crash, stored"][0][4] = str(connection.execute("SELECT id FROM crash").fetchone()[0])
    connection.close()
    for name, (_, share, program) in COMMANDS.items():
        if a.only and name not in a.only:
            continue
        right = run(name, source)
        if right[0] != 0:
            sys.exit(f"{name}: {right}")
        number = right[4]
        assert number > 100, (name, number)
        step = max(1, round(number / (a.samples * share))) if a.samples else 1
        # One more or less, so that a step is no multiple of what repeats.
        places, paths = list(range(1, number + 1, step)), 0
        if a.per_path:
            with tempfile.TemporaryDirectory() as recorded:
                recorded = pathlib.Path(recorded)
                run(name, source, paths=recorded)
                places, paths = by_path(sorted(recorded.iterdir()))
        faults = collections.defaultdict(list)
        with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
            for at, found in zip(places, pool.map(lambda k: run(name, source, k), places)):
                fault = judge(right, found, program)
                if fault:
                    faults[re.sub("[0-9]{4,}", "N", fault)].append(at)
        tried += len(places)
        by = f", {paths} paths of calls" if paths else ""
        print(f"{name}: {len(places)} of {number} requests refused{by}", flush=True)
        for fault, where in faults.items():
            wrong += len(where)
            print(f"  {len(where)} times, first at {where[0]}: {fault}", flush=True)
print(f"{tried} requests for memory refused, {wrong} times something was wrong")
sys.exit(1 if wrong or tried == 0 else 0)
