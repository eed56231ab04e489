# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGKILL at random, workers and runner, all in one study: what the resumed study ends with is, row by
row, what an undisturbed one has. The whole of it: `cmake --build build --target kill_200`."""
import argparse
import os
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
        os.kill(pid, signal.SIGKILL)
        return True
    except (OSError, ProcessLookupError):
        return False


def is_at_work(pid):
    """Whether a worker has begun with a replication (others only try whether SUMO starts)."""
    try:
        return b"--replication" in pathlib.Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


def wait_for_replication(runner):
    while runner.poll() is None and not any(map(is_at_work, workers_of(runner.pid))):
        time.sleep(0.005)


def done_in(db):
    """Replications done so far; 0 while there is no database yet."""
    try:
        connection = sqlite3.connect(f"file:{db}?mode=ro", uri=True, timeout=60)
        try:
            return connection.execute("SELECT count(*) FROM replication WHERE status = 'done'"
                                      ).fetchone()[0]
        finally:
            connection.close()
    except sqlite3.OperationalError:
        return 0


def disturb(study, db, generator, kills, pause_s):
    """Run the study to its end with kills spread over all of it: as many a finished replication as
    make the number by the last. How many of each kind were done, and restarts."""
    words = [arguments.crashpulse, "run", str(study), "--db", str(db), "--jobs", "2"]
    total = 2 * arguments.replications
    done = {"worker": 0, "runner": 0}
    restarts = 0

    def start():
        return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    runner = start()
    while sum(done.values()) < kills:
        # At a random moment, of a replication mostly, of the preparations before it now and then;
        # soon, when the study is far ahead of the kills or near its end.
        finished = done_in(db)
        behind = kills * (finished + 2) / total - sum(done.values())
        hurry = behind >= 8 or finished >= total - 3
        if generator.random() < 0.8:
            wait_for_replication(runner)
        time.sleep(generator.uniform(0.0, pause_s / 4 if hurry else pause_s / 2))
        if runner.poll() is not None:
            # It has ended by itself, with the failures that killed workers are.
            assert runner.returncode == 1, ("the study ended before the kills", done)
            runner = start()
            restarts += 1
        elif behind > 0:
            workers = workers_of(runner.pid)
            if workers and generator.random() < 0.6:
                done["worker"] += kill(generator.choice(workers))
            else:
                runner.kill()
                runner.wait()
                done["runner"] += 1
                restarts += 1
                runner = start()
    # Left in peace: failures of the past are tried again, at the latest by the second run.
    runner.wait()
    crossing_study.run(arguments.crashpulse, *words[1:], expect=None)
    crossing_study.run(arguments.crashpulse, *words[1:])
    return done, restarts


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    study = crossing_study.write(folder, arguments.network, arguments.replications,
                                 arguments.duration)
    undisturbed, disturbed = folder / "undisturbed.db", folder / "disturbed.db"
    started_s = time.monotonic()
    crossing_study.run(arguments.crashpulse, "run", study, "--db", undisturbed)
    # About a replication, so that kills fall into them as well as between and before them.
    pause_s = (time.monotonic() - started_s) / arguments.replications
    done, restarts = disturb(study, disturbed, random.Random(20), arguments.kills, pause_s)
    crossing_study.assert_same(disturbed, undisturbed)
    crossing_study.run(arguments.crashpulse, "check", disturbed)
    outcomes = dict(sqlite3.connect(disturbed).execute(
        "SELECT outcome, count(*) FROM attempt GROUP BY outcome").fetchall())
    assert "running" not in outcomes and outcomes["done"] == 2 * arguments.replications, outcomes
    print(f"one study of {2 * arguments.replications} replications: {done['worker']} workers and "
          f"{done['runner']} runners killed, {restarts} restarts; attempts: {outcomes}; the rows of an "
          f"undisturbed run")
