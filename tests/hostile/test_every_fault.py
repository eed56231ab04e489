# SPDX-License-Identifier: GPL-3.0-or-later
"""Every call that can fail does so in turn, one a run of a command: of the database's files opening, reading,
writing (after half of it), a full disk, syncing, truncating, locking, mapping, deleting; of the system renaming,
syncing, starting a process, pipes, forks, temporary files. Signals arrive at each of these calls; the power goes at
each write, sync, truncation and deletion, and of what was not synced nothing, all or any of its sectors is on the disk;
SUMO ends, hangs or throws at any moment; the clock of the day jumps. Each time the command either gives what it
always gives, or ends with a message and exit code 1; the same command without the fault then gives the rows of an
undisturbed one: nothing lost, nothing doubled. --cases N: N faults a command, of all kinds, instead of all."""
import argparse
import collections
import concurrent.futures
import hashlib
import os
import pathlib
import random
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study
import hostile

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--calls", required=True, help="failing_calls.so")
parser.add_argument("--sumo", required=True, help="failing_sumo.so")
parser.add_argument("--db", required=True, help="a study's database")
parser.add_argument("--network", required=True, help="folder of the crossing")
parser.add_argument("--vehicles", required=True)
parser.add_argument("--cases", type=int, default=0, help="of each command; 0: all")
parser.add_argument("--jobs", type=int, default=2)
parser.add_argument("--seed", type=int, default=20, help="of what survives a power cut")
parser.add_argument("--only", action="append", help="errors, signals, power, sumo, clock")
parser.add_argument("--command", action="append", help="this command only")
a = parser.parse_args()

OF_DATABASES = ("open", "read", "write", "full", "sync", "truncate", "lock", "map", "delete")
OF_SYSTEM = ("rename", "fsync", "spawn", "pipe", "fork", "temp")
RUN = ["run", "study.yaml", "--db", "study.db", "--jobs", "1"]
# Words, the program that suffers.
COMMANDS = {
    "run": (RUN, "crashpulse"),
    "run, its workers": (RUN, "crashpulse-worker"),
    "run, counterfactual": (["run", "pairs.yaml", "--db", "study.db", "--jobs", "1"], "crashpulse-worker"),
    "merge": (["merge", "out.db", "part.db"], "crashpulse"),
    "compare": (["compare", "small.db", "--format", "json"], "crashpulse"),
    "report": (["report", "small.db", "--output", "r.html"], "crashpulse"),
    "plot": (["plot", "small.db", "benefit", "--output", "f.svg"], "crashpulse"),
    "check": (["check", "part.db", "--format", "csv"], "crashpulse"),
    "status": (["status", "small.db"], "crashpulse"),
    "sql": (["sql", "small.db", "SELECT median(olc_g, censored) FROM frontal_vehicle"], "crashpulse"),
    "assess": (["assess", "--configurations", "list.csv", "--format", "csv", "--db", "list.db"],
               "crashpulse"),
    "crash": (["crash", "car.yaml", "--speed", "56", "--pulse", "p.csv", "--format", "json"],
              "crashpulse"),
}
WRITING = ("run", "run, its workers", "run, counterfactual", "merge", "assess", "compare")
TIMES = re.compile(rb"[0-9.]+ s\b|[0-9:]+ left")
Found = collections.namedtuple("Found", "code out err")


# ---- a command in a folder of its own -----------------------------------------------------------

def prepare(folder):
    study = crossing_study.write(folder, a.network, replications=1, duration_s=20)
    (folder / "pairs.yaml").write_text(study.read_text().replace("paired_seeds", "counterfactual"))
    (folder / "list.csv").write_text(hostile.LIST)
    shutil.copy(a.db, folder / "small.db")
    clean(folder, RUN)
    (folder / "study.db").rename(folder / "part.db")
    for path in folder.glob("study.db-*"):
        path.unlink()


def clean(folder, words, expect=0):
    """Without a fault."""
    result = subprocess.run([a.crashpulse, *words], cwd=folder, capture_output=True, timeout=300)
    assert result.returncode == expect, (words, result)
    return result


def faulty(folder, words, environment, limit_s=120):
    temporary = folder / "tmp"
    temporary.mkdir(exist_ok=True)
    preload = f"{a.calls}:{a.sumo}" if "SUMO_FAULT" in environment else a.calls
    process = subprocess.Popen([a.crashpulse, *words], cwd=folder, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, start_new_session=True,
                               env=dict(os.environ, LD_PRELOAD=preload, TMPDIR=str(temporary), **environment))
    try:
        out, err = process.communicate(timeout=limit_s)
    except subprocess.TimeoutExpired:
        process.kill()
        return Found("no end", *process.communicate())
    return Found(process.returncode, out, err)


def left_workers(folder):
    """Processes of ours that work in the folder and have outlived the command."""
    until = time.monotonic() + 20
    while True:
        found = []
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if pathlib.Path(os.readlink(path / "cwd")) == folder and \
                        "Z" != (path / "stat").read_text().rsplit(")", 1)[1].split()[0]:
                    found.append(path.name)
            except OSError:
                continue
        if not found or time.monotonic() > until:
            return found
        time.sleep(0.05)


def rows(path):
    """Of a database, without who worked on it when."""
    found = crossing_study.rows(path)
    found.pop("comparison", None)  # numbered anew each time it is written
    found.pop("comparison_figure", None)
    return found


def outcome(folder, words, result):
    """What a command gave: its output, files and rows."""
    out = TIMES.sub(b"", result.stdout if hasattr(result, "stdout") else result.out)
    files = {p.name: hashlib.sha256(p.read_bytes()).hexdigest()
             for p in folder.iterdir() if p.name in ("r.html", "f.svg", "p.csv")}
    bases = {p.name: rows(p) for p in sorted(folder.glob("*.db"))}
    return out, files, bases


def damage(folder):
    for path in folder.glob("*.db"):
        connection = sqlite3.connect(path)
        found = connection.execute("PRAGMA integrity_check").fetchall()
        connection.close()
        if found != [("ok",)]:
            return f"{path.name}: {found[:2]}"
    return None


def doubled(folder):
    """More or less than one good attempt a replication, or one that never ends."""
    for path in folder.glob("*.db"):
        connection = sqlite3.connect(path)
        try:
            wrong = connection.execute(
                "SELECT count(*) FROM replication AS r WHERE status <> 'done' OR 1 <> (SELECT count(*) FROM attempt "
                "WHERE replication_id = r.id AND outcome = 'done')").fetchone()[0]
            running = connection.execute("SELECT count(*) FROM attempt WHERE outcome = 'running'").fetchone()[0]
        finally:
            connection.close()
        if (wrong or running) and path.name == "study.db":
            return f"{path.name}: {wrong} replications not done once, {running} attempts running"
    return None


class Case:
    """One command with one fault."""

    def __init__(self, name, environment, prepare=None, codes=(0, 1), limit_s=120, words=()):
        self.name, self.environment, self.codes = name, environment, codes
        self.words, self.more_words = COMMANDS[name][0], list(words)
        self.prepare, self.limit_s = prepare, limit_s

    def judge(self, source, right):
        """The exit code, and what is wrong, if anything."""
        with tempfile.TemporaryDirectory() as text:
            folder = pathlib.Path(text)
            shutil.copytree(source, folder, dirs_exist_ok=True)
            after = self.prepare(folder) if self.prepare else None
            environment = {key: value.replace("FOLDER", text) for key, value in self.environment.items()}
            found = faulty(folder, self.words + self.more_words, environment, self.limit_s)
            left = left_workers(folder)
            if left:
                return found.code, f"processes are left: {left}"
            wrong = self.judge_end(folder, found, right)
            if wrong:
                return found.code, wrong
            if after:
                after()
            if found.code != 0 or after:
                return found.code, self.judge_again(folder, right)
            return 0, None

    def judge_end(self, folder, found, right):
        err = found.err.decode(errors="replace")
        if found.code not in self.codes:
            return f"exit code {found.code}: {err[-300:]}"
        if found.code == 0 and self.prepare is None:
            got = outcome(folder, self.words, found)
            if got != right:
                return f"exit code 0 with another result: {[g == r for g, r in zip(got, right)]}"
        if found.code in (1, 2) and (not re.search("^crashpulse: error: .", err, re.M) or "(null)" in err):
            return f"exit code {found.code} without a message: {err[-300:]}"
        if found.code == 1 and [p for p in (folder / "tmp").iterdir()]:
            return f"left behind: {list((folder / 'tmp').iterdir())}"
        if found.code == 1 and list(folder.glob("*.part*")) + list(folder.glob("*.tmp*")):
            return f"left behind in the folder: {sorted(p.name for p in folder.iterdir())}"
        return None

    def judge_again(self, folder, right):
        """The same without the fault: as if nothing had been."""
        for path in folder.glob("*.db"):
            if path.stat().st_size == 0:
                path.unlink()  # as a user finds it: nothing was begun
        result = subprocess.run([a.crashpulse, *self.words], cwd=folder, capture_output=True, timeout=300)
        if result.returncode != 0:
            return f"again: exit code {result.returncode}: {result.stderr[-300:]}"
        again = outcome(folder, self.words, result)
        if self.name not in ("merge", "assess") and again[0] != right[0]:
            return "again: another output"
        if again[1] != right[1]:
            return "again: other files"
        for name, tables in right[2].items():
            if again[2].get(name) != tables:
                return f"again: {name} has other rows"
        return damage(folder) or doubled(folder)


# ---- power --------------------------------------------------------------------------------------

def power_goes(seed, survives):
    """Prepare a folder for a power cut; what makes of it what lay on the disk."""
    def before(folder):
        disk = folder / "disk"
        disk.mkdir()
        for path in folder.glob("*.db"):
            shutil.copy(path, disk)

        def after():
            generator = random.Random(seed)
            for path in folder.glob("*.db-shm"):
                path.unlink()
            names = {p.name for p in folder.glob("*.db*")} | {p.name for p in disk.glob("*.db*")}
            for name in sorted(n for n in names if not n.endswith(".half")):
                lay_down(folder / name, disk / name, generator, survives)
            shutil.rmtree(disk)
        return after
    return before


def lay_down(path, safe, generator, survives):
    """Sector by sector what was synced, or what was written since."""
    now = path.read_bytes() if path.exists() else None
    synced = safe.read_bytes() if safe.exists() else None
    if survives == "all" or now == synced:
        return
    if survives == "nothing":
        mixed = synced
    elif now is None or synced is None:  # the entry of the folder itself may be there or not
        mixed = generator.choice([now, synced])
    else:
        size = generator.choice([len(now), len(synced)])
        sectors = []
        for begin in range(0, size, 512):
            old, new = synced[begin:begin + 512], now[begin:begin + 512]
            piece = generator.choice([old, new, new[:100] + old[100:]])
            sectors.append(piece.ljust(min(512, size - begin), b"\0")[:size - begin])
        mixed = b"".join(sectors)
    if mixed is None:
        path.unlink(missing_ok=True)
    else:
        path.write_bytes(mixed)


# ---- all cases ----------------------------------------------------------------------------------

def some(cases, name):
    """--cases of them: one of each kind in turn, whichever."""
    generator = random.Random(f"{a.seed} {name}")
    by_kind = collections.defaultdict(list)
    for case in cases:
        by_kind[case[0]].append(case)
    chosen, kinds = [], [by_kind[kind] for kind in sorted(by_kind)]
    generator.shuffle(kinds)
    while len(chosen) < a.cases and any(kinds):
        for left in kinds:
            if left and len(chosen) < a.cases:
                chosen.append(left.pop(generator.randrange(len(left))))
    return chosen


def count_calls(source, name):
    """How often each kind is called, at most in one process of the program."""
    words, program = COMMANDS[name]
    with tempfile.TemporaryDirectory() as text:
        folder = pathlib.Path(text)
        shutil.copytree(source, folder, dirs_exist_ok=True)
        found = faulty(folder, words, {"FAULT_COUNT": str(folder / "count")})
        assert found.code == 0, found
        counts = collections.Counter()
        for line in (folder / "count").read_text().splitlines():
            who, kind, number = line.split()
            if who == program:
                counts[kind] = max(counts[kind], int(number))
        return counts, outcome(folder, words, found)


def error_cases(name, counts):
    program = COMMANDS[name][1]
    for kind in OF_DATABASES + OF_SYSTEM:
        for number in range(1, counts[kind] + 1):
            for what in ("error", "error_on"):
                yield f"{kind} failed", Case(name, {"FAULT_KIND": kind, "FAULT_AT": str(number), "FAULT_IN": program,
                                                    "FAULT_DO": what})


def signal_cases(name, counts):
    program = COMMANDS[name][1]
    whom = ["signal"] + (["parent"] if program != "crashpulse" else [])
    for kind in ("read", "write", "sync", "lock", "spawn"):
        for number in range(1, counts[kind] + 1):
            for who in whom:
                for signal in (2, 9, 15):
                    yield f"signal {signal}", Case(
                        name, {"FAULT_KIND": kind, "FAULT_AT": str(number), "FAULT_IN": program,
                               "FAULT_DO": f"{who} {signal}"}, codes=(0, 1, -signal))


def power_cases(name, counts):
    program = COMMANDS[name][1]
    for kind in ("write", "sync", "truncate", "delete"):
        for number in range(1, counts[kind] + 1):
            for survives in ("nothing", "some", "all"):
                yield "power cut", Case(
                    name, {"FAULT_KIND": kind, "FAULT_AT": str(number), "FAULT_IN": program, "FAULT_DO": "cut",
                           "FAULT_DISK": "FOLDER/disk"}, codes=(0, -9),
                    prepare=power_goes(f"{a.seed} {name} {kind} {number}", survives))


def sumo_cases(name, _):
    if name != "run":
        return
    for where in ("start 1", "step 1", "step 2", "step 100", "step 199"):
        for how in ("abort", "segv", "exit0", "exit3", "throw", "throw_int", "empty", "hang"):
            limit = ["--time-limit", "4"] if how == "hang" else []
            # What SUMO says of a configuration that it does not start is for its author: bad input.
            codes = (1, 2) if how in ("throw", "throw_int", "empty") else (1,)
            yield f"SUMO: {how}", Case(name, {"SUMO_FAULT": f"{where} {how}"}, codes=codes, words=limit)


def clock_cases(name, counts):
    if name not in ("run", "compare", "merge"):
        return
    for number in range(1, counts["clock"] + 1):
        for jump in ("34560000", "-34560000", "-1700000000", "8000000000"):
            yield "clock jumped", Case(name, {"FAULT_CLOCK": f"{number}:{jump}"}, codes=(0,))


KINDS = {"errors": error_cases, "signals": signal_cases, "power": power_cases, "sumo": sumo_cases,
         "clock": clock_cases}
tried, acted, wrong = collections.Counter(), collections.Counter(), 0
with tempfile.TemporaryDirectory() as text:
    source = pathlib.Path(text) / "source"
    source.mkdir()
    prepare(source)
    for name in COMMANDS:
        if a.command and name not in a.command:
            continue
        counts, right = count_calls(source, name)
        cases = []
        for kind, make in KINDS.items():
            if (not a.only or kind in a.only) and (kind in ("errors", "sumo", "clock") or name in WRITING):
                cases += list(make(name, counts))
        cases = some(cases, name) if a.cases else cases
        faults = collections.defaultdict(list)
        with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
            for (what, case), (code, fault) in zip(cases, pool.map(lambda c: c[1].judge(source, right), cases)):
                tried[what] += 1
                acted[what] += code != 0
                if fault:
                    faults[re.sub("[0-9]{5,}|/tmp/[^/' ]*", "N", fault)].append(case.environment)
        print(f"{name}: {len(cases)} faults", flush=True)
        for fault, where in faults.items():
            wrong += len(where)
            print(f"  {len(where)} times, first {where[0]}: {fault}", flush=True)
print(", ".join(f"{number} {what}" for what, number in sorted(tried.items())))
print(f"{sum(tried.values())} faults, {wrong} times something was wrong")
# Some faults are withstood, not all of them.
sys.exit(1 if wrong or not sum(acted.values()) else 0)
