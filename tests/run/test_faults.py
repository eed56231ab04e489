# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes wrong around a study: the disk is full, the database cannot be written, is of a newer
version, is damaged, or two runs share it; workers hang; .sumocfg files write output. Each time a
clear message and the right exit code, nothing lost, nothing doubled."""
import argparse
import os
import pathlib
import shutil
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
parser.add_argument("--only", help="one case")
arguments = parser.parse_args()
crashpulse = arguments.crashpulse


def run(*words, expect=0):
    return crossing_study.run(crashpulse, *words, expect=expect)


def says(result, *words):
    for word in words:
        assert word in result.stderr, (word, result.stderr)


class SmallDisk:
    """A file system of a few hundred kilobytes."""

    def __init__(self, folder, kilobytes):
        self.folder = folder
        folder.mkdir()
        self.mount(f"size={kilobytes}k")

    def mount(self, options):
        subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", self.folder], check=True)

    def remount(self, options):
        subprocess.run(["mount", "-o", f"remount,{options}", self.folder], check=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", self.folder], check=True)


def can_mount(folder):
    probe = folder / "probe"
    try:
        with SmallDisk(probe, 100):
            return True
    except (subprocess.CalledProcessError, FileNotFoundError):
        return False


def disk_full(folder, study, undisturbed):
    # Full at different moments: at the schema, at the plan, at results.
    for kilobytes in (60, 400):
        disk = folder / f"disk_{kilobytes}"
        with SmallDisk(disk, kilobytes) as small:
            db = disk / "study.db"
            result = run("run", study, "--db", db, expect=1)
            says(result, "study.db", "the disk is full")
            small.remount("size=20m")
            run("run", study, "--db", db)
            crossing_study.assert_same(db, undisturbed)
            run("check", db)
            # A finished one stands alone, and reading it needs no room.
            assert not (disk / "study.db-wal").exists() and not (disk / "study.db-shm").exists()
            small.remount(f"size={db.stat().st_size // 1024 + 64}k")
            with open(disk / "rest", "wb", buffering=0) as rest:
                try:
                    while True:
                        rest.write(bytes(4096))
                except OSError:
                    pass
            assert "baseline" in run("status", db).stdout


def read_only(folder, study, undisturbed):
    with SmallDisk(folder / "read_only", 20000) as small:
        db = folder / "read_only" / "study.db"
        shutil.copy(undisturbed, db)
        before = db.read_bytes()
        small.remount("ro")
        says(run("run", study, "--db", db, expect=1), str(db), "cannot be written: Read-only file system")
        says(run("run", study, "--db", folder / "read_only" / "new.db", expect=2), "new.db")
        assert db.read_bytes() == before
        # Reading goes on: files of a study may well lie on such a disk.
        assert "baseline" in run("status", db).stdout
        assert "baseline" in run("compare", db).stdout


def newer_version(folder, study, undisturbed):
    db = folder / "newer.db"
    shutil.copy(undisturbed, db)
    with sqlite3.connect(db) as connection:
        connection.execute("PRAGMA user_version = 4711")
    connection.close()
    before = db.read_bytes()
    for words in (["run", study, "--db", db], ["status", db], ["check", db], ["check", "-u", db],
                  ["merge", folder / "out.db", db], ["sql", db, "SELECT 1"]):
        says(run(*words, expect=2), "newer.db", "newer crashpulse (schema version 4711")
    assert db.read_bytes() == before


def damaged(folder, study, undisturbed):
    # The beginning, pages in the middle, a page of pulses that nothing needs for going on, the end:
    # check finds it, and so does run before it changes anything.
    size = undisturbed.stat().st_size
    connection = sqlite3.connect(undisturbed)
    page_size = connection.execute("PRAGMA page_size").fetchone()[0]
    start = page_size * (connection.execute("SELECT max(pageno) FROM dbstat WHERE name = 'pulse' AND "
                                            "pagetype = 'leaf'").fetchone()[0] - 1)
    connection.close()
    for name, change in (("leaf", lambda b: b[:start] + b"\xff" * page_size + b[start + page_size:]),
                         ("header", lambda b: b[:20] + bytes(60) + b[80:]),
                         ("middle", lambda b: b[:8192] + bytes(range(256)) * 64 + b[24576:]),
                         ("short", lambda b: b[:size // 2])):
        db = folder / f"damaged_{name}.db"
        db.write_bytes(change(undisturbed.read_bytes()))
        before = db.read_bytes()
        result = run("check", db, expect=None)
        assert result.returncode in (1, 2), (name, result)
        assert "damaged_" in result.stderr, (name, result.stderr)
        result = run("run", study, "--db", db, expect=None)
        assert result.returncode in (1, 2) and f"damaged_{name}.db" in result.stderr, (name, result)
        if name != "header":
            says(result, f"damaged_{name}.db: is damaged: ")
        assert db.read_bytes() == before, name


def two_runs(folder, study, undisturbed):
    db = folder / "shared.db"
    words = [crashpulse, "run", str(study), "--db", str(db), "--jobs", "2"]
    runs = [subprocess.Popen(words, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    ends = [(r.communicate()[1], r.returncode) for r in runs]
    assert [code for _, code in ends] == [0, 0], ends
    crossing_study.assert_same(db, undisturbed)
    # Nothing was done twice, and the two say together what was done.
    connection = sqlite3.connect(db)
    total = connection.execute("SELECT count(*) FROM replication").fetchone()[0]
    attempts = connection.execute("SELECT outcome, count(*) FROM attempt GROUP BY 1").fetchall()
    assert attempts == [("done", total)], attempts
    now = sum(int(text.split(" done now")[0].split()[-1]) for text, _ in ends)
    before = sum(int(text.split(" done before")[0].split()[-1]) for text, _ in ends)
    assert now == total or before > 0, ends


def shards(folder, study, undisturbed):
    out = folder / "merged.db"
    parts = [folder / f"part_{k}.db" for k in (1, 2, 3)]
    for k, part in enumerate(parts, 1):
        run("run", study, "--db", part, "--shard", f"{k}/3")
    done = [sqlite3.connect(p).execute("SELECT count(*) FROM replication WHERE status = 'done'")
            .fetchone()[0] for p in parts]
    assert sorted(done) == [2, 3, 3], done
    run("merge", out, parts[0], parts[1])
    says(run("merge", out, parts[1], parts[2], parts[0]), "0 replications taken", "8 of 8")
    crossing_study.assert_same(out, undisturbed)
    run("check", out)
    # Again: nothing changes, not even a time.
    dump = "\n".join(sqlite3.connect(out).iterdump())
    run("merge", out, *parts, undisturbed)
    assert "\n".join(sqlite3.connect(out).iterdump()).count("merge_source") == \
        dump.count("merge_source")
    crossing_study.assert_same(out, undisturbed)
    # And the study goes on in the merged database as in any other.
    says(run("run", study, "--db", out), "8 done before")

    # Other studies, other states, other results are refused; the output stays.
    other = folder / "other"
    other.mkdir()
    study_2 = crossing_study.write(other, arguments.network, 2, 10, seed=6)
    run("run", study_2, "--db", other / "other.db")
    says(run("merge", out, other / "other.db", expect=2), "other.db: holds another study than",
         "study differ")
    lie = folder / "lie.db"
    shutil.copy(parts[0], lie)
    with sqlite3.connect(lie) as connection:
        connection.execute("UPDATE replication SET vehicle_km = vehicle_km + 1 WHERE status = "
                           "'done'")
    connection.close()
    says(run("merge", out, lie, expect=2), "lie.db", "has other results than in")
    says(run("merge", folder / "new_out.db", folder / "nothing.db", expect=2), "no such database")
    crossing_study.assert_same(out, undisturbed)


def hanging_worker(folder, study, undisturbed):
    # A worker that never ends, for one of the replications; the others go on.
    worker = pathlib.Path(crashpulse).parent / "crashpulse-worker"
    programs = folder / "programs"
    programs.mkdir()
    shutil.copy(crashpulse, programs / "crashpulse")
    script = programs / "crashpulse-worker"
    first = sqlite3.connect(undisturbed).execute("SELECT min(id) FROM replication").fetchone()[0]
    script.write_text(f"#!/bin/sh\ncase \"$*\" in *'--replication {first} '*) echo 'Step #12.50 is "
                      f"taking its time' >&2; exec sleep 600;; esac\nexec '{worker}' \"$@\"\n")
    script.chmod(0o755)
    db = folder / "hanging.db"
    result = crossing_study.run(programs / "crashpulse", "run", study, "--db", db, "--jobs", "2",
                                "--time-limit", "30", expect=1)
    says(result, "1 of 8 replications failed", "no end after 30 s", "Step #12.50 is taking its time")
    status = run("status", db).stdout
    assert "7 of 8 replications done" in status and "no end after 30 s" in status, status

    # Of many last words the first line and the last are told: the last says what ended it.
    long_words = "\n".join(["first", *["Warning: one of many"] * 40, "Assertion failed"])
    with sqlite3.connect(db) as connection:
        connection.execute("UPDATE attempt SET message = ? WHERE outcome = 'failed'", (long_words,))
    status = run("status", db).stdout
    assert ": first\n    ...\n    Assertion failed\n" in status, status
    assert "one of many" not in status, status
    run("run", study, "--db", db)
    crossing_study.assert_same(db, undisturbed)


def interrupt(folder, study, undisturbed):
    # Ctrl-C goes to the whole foreground group; the runner ends its workers and says how to go on.
    db = folder / "interrupted.db"
    runner = subprocess.Popen([crashpulse, "run", str(study), "--db", str(db), "--jobs", "1"],
                              stderr=subprocess.PIPE, text=True, start_new_session=True)
    while not db.exists() or sqlite3.connect(db, timeout=60).execute(
            "SELECT count(*) FROM sqlite_schema WHERE name = 'attempt'").fetchone() == (0,) or \
            sqlite3.connect(db, timeout=60).execute(
                "SELECT count(*) FROM attempt").fetchone() < (2,):
        time.sleep(0.02)
    # Watched while it runs.
    assert " running" in run("status", db).stdout
    os.killpg(runner.pid, signal.SIGINT)
    text = runner.communicate()[1]
    assert runner.returncode == 1 and "the same command goes on from there" in text, text
    assert sqlite3.connect(db).execute("SELECT count(*) FROM replication WHERE status = 'running'"
                                       ).fetchone() == (0,)
    run("run", study, "--db", db)
    crossing_study.assert_same(db, undisturbed)


def outputs_of_sumo(folder, study, undisturbed):
    # The user's .sumocfg writes files: every replication its own, whole ones.
    mine = folder / "outputs"
    mine.mkdir()
    study = crossing_study.write(mine, arguments.network, 2, 20)
    configuration = mine / "net" / "crossing.sumocfg"
    configuration.write_text(configuration.read_text().replace(
        "</configuration>", "<output><tripinfo-output value=\"trips.xml\"/></output>"
        "</configuration>"))
    run("run", study, "--db", mine / "study.db", "--jobs", "2")
    seeds = sqlite3.connect(mine / "study.db").execute(
        "SELECT v.name, r.seed FROM replication AS r JOIN variant AS v ON v.id = r.variant_id")
    for variant, seed in seeds.fetchall():
        text = (mine / "net" / f"crossing_{variant}_{seed}_trips.xml").read_text()
        assert text.rstrip().endswith("</tripinfos>"), text[-200:]
    assert not (mine / "net" / "trips.xml").exists()


def read_only_tmp(folder, study, undisturbed):
    # Nobody may write into /tmp and /var/tmp: TMPDIR is where everything goes.
    with tempfile.TemporaryDirectory(dir=os.getcwd()) as text:
        place = pathlib.Path(text)
        mine = crossing_study.write(place, arguments.network, 1, 10)
        (place / "own").mkdir()

        def there(*words, expect=0, **more):
            result = subprocess.run(
                ["unshare", "-m", "sh", "-c", "mount -t tmpfs -o ro none /tmp && mount -t tmpfs -o ro "
                 'none /var/tmp && exec "$@"', "sh", crashpulse, *map(str, words)], cwd=place,
                env={**os.environ, **more}, capture_output=True, text=True)
            assert result.returncode == expect, (words, result)
            return result

        own = {"TMPDIR": str(place / "own")}
        db = place / "study.db"
        there("run", mine, "--db", db, **own)
        there("background", mine, "--duration", "5", **own)
        shutil.copy(undisturbed, place / "many.db")
        for words in (["compare", "many.db"], ["report", "many.db", "--output", "r.html"], ["check", db],
                      ["plot", "many.db", "olc", "--output", "f.svg"], ["merge", "sum.db", db],
                      ["sql", "many.db", "SELECT median(olc_g, censored) FROM frontal_vehicle"]):
            there(*words, **own)
        assert not list((place / "own").iterdir())
        # Without one it is said where nothing can be written.
        for words in (["run", mine, "--db", place / "new.db"], ["background", mine], ["plot", "many.db",
                      "olc", "--output", "f.svg"]):
            says(there(*words, expect=1, TMPDIR=""), "/tmp", "Read-only file system")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    study = crossing_study.write(folder, arguments.network, replications=4, duration_s=20)
    undisturbed = folder / "undisturbed.db"
    run("run", study, "--db", undisturbed)
    cases = [newer_version, damaged, two_runs, shards, hanging_worker, interrupt, outputs_of_sumo]
    if can_mount(folder):
        cases += [disk_full, read_only, read_only_tmp]
    else:
        print("skipped: disk_full, read_only and read_only_tmp need the right to mount a file system")
    for case in cases:
        if arguments.only and case.__name__ != arguments.only:
            continue
        case(folder, study, undisturbed)
        print(f"{case.__name__}: good", flush=True)
