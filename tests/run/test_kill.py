# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGKILL at random, workers and runner, while a study runs: what the resumed study ends with is, row
by row, what an undisturbed one has. The whole of it: `cmake --build build --target kill_200`."""
import argparse
import pathlib
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True)
parser.add_argument("--kills", type=int, default=10)
parser.add_argument("--replications", type=int, default=4, help="per variant; there are two")
parser.add_argument("--duration", type=int, default=40, help="simulated seconds")
arguments = parser.parse_args()


def workers_of(pid):
    """Process ids of the workers of a runner: its children."""
    try:
        tasks = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        return []
    return [int(task) for task in tasks]


def kill(pid):
    try:
        pathlib.Path(f"/proc/{pid}/stat").read_text()
        subprocess.os.kill(pid, signal.SIGKILL)
        return True
    except (OSError, ProcessLookupError):
        return False


def disturb(study, db, generator, kills, pause_s):
    """Run the study to its end, killing on the way; how many kills of each kind were done."""
    words = [arguments.crashpulse, "run", str(study), "--db", str(db), "--jobs", "2"]
    done = {"worker": 0, "runner": 0}
    runner = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while sum(done.values()) < kills:
        time.sleep(generator.uniform(0.0, pause_s))
        if runner.poll() is not None:
            # It has ended by itself: complete, or with the failures that killed workers are.
            if runner.returncode == 0:
                break
            runner = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            continue
        workers = workers_of(runner.pid)
        if workers and generator.random() < 0.6:
            done["worker"] += kill(generator.choice(workers))
        else:
            runner.kill()
            runner.wait()
            done["runner"] += 1
            runner = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    # Left in peace: failures of the past are tried again, at the latest by the second run.
    runner.wait()
    crossing_study.run(arguments.crashpulse, *words[1:], expect=None)
    crossing_study.run(arguments.crashpulse, *words[1:])
    return done


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    study = crossing_study.write(folder, arguments.network, arguments.replications,
                                 arguments.duration)
    undisturbed = folder / "undisturbed.db"
    started_s = time.monotonic()
    crossing_study.run(arguments.crashpulse, "run", study, "--db", undisturbed)
    # So that kills fall into replications as well as between and before them.
    pause_s = 2.0 * (time.monotonic() - started_s) / arguments.replications
    generator = random.Random(20)
    total = {"worker": 0, "runner": 0}
    studies = 0
    while sum(total.values()) < arguments.kills:
        db = folder / f"disturbed_{studies}.db"
        done = disturb(study, db, generator, arguments.kills - sum(total.values()),
                       pause_s)
        total = {kind: total[kind] + done[kind] for kind in total}
        studies += 1
        crossing_study.assert_same(db, undisturbed)
        crossing_study.run(arguments.crashpulse, "check", db)
        outcomes = dict(sqlite3.connect(db).execute(
            "SELECT outcome, count(*) FROM attempt GROUP BY outcome").fetchall())
        assert "running" not in outcomes and outcomes["done"] == 2 * arguments.replications, outcomes
        print(f"study {studies}: {done['worker']} workers and {done['runner']} runners killed; "
              f"attempts: {outcomes}", flush=True)
    print(f"{total['worker']} workers and {total['runner']} runners killed in {studies} studies of "
          f"{2 * arguments.replications} replications: the rows of an undisturbed run each time")
