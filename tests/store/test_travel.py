# SPDX-License-Identifier: GPL-3.0-or-later
"""Databases travel: a finished one is one file that somebody without the right to write reads, and a
reader never leaves files beside it that shut its owner out. Rights count for nobody who is root, so
then the readers run as another user."""
import argparse
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--calls", help="library whose statfs says NFS")
arguments = parser.parse_args()
LIST = ("id,vehicle_a,vehicle_b,speed_a_km_h,speed_b_km_h,offset_mm,angle_deg\n"
        "one,van,suv,50,40,0,0\ntwo,small_car,mid_size,45,45,300,10\n")
NOBODY = 65534
other_user = dict(user=NOBODY, group=NOBODY, extra_groups=[]) if os.geteuid() == 0 else {}

work = pathlib.Path(tempfile.mkdtemp(prefix="travel-"))
work.chmod(0o755)
# Where the other user can start it from.
program = work / "bin" / "crashpulse"
program.parent.mkdir()
for name in ("crashpulse", "crashpulse_sql.so"):
    shutil.copy(pathlib.Path(arguments.crashpulse).with_name(name), program.parent / name)


def run(*words, expect=0, colleague=False, environment=None):
    result = subprocess.run([str(program), *map(str, words)], capture_output=True, text=True, cwd=work,
                            env={**os.environ, **(environment or {})}, **(other_user if colleague else {}))
    if result.returncode != expect:
        sys.exit(f"{words}: exit code {result.returncode}, not {expect}\n{result.stdout}{result.stderr}")
    return result


def must(holds, what):
    if not holds:
        sys.exit(what)


def folder(name, database, folder_mode, file_mode):
    """A folder of the owner with a copy of the database and of what lies beside it."""
    place = work / name
    place.mkdir()
    for suffix in ("", "-wal", "-shm"):
        if pathlib.Path(f"{database}{suffix}").exists():
            shutil.copy(f"{database}{suffix}", place / f"s.db{suffix}")
            (place / f"s.db{suffix}").chmod(file_mode)
    place.chmod(folder_mode)
    return place / "s.db"


def read_all(database):
    """Every command that reads; the folder is as before. What status says is returned."""
    before = sorted((path.name, path.read_bytes()) for path in database.parent.iterdir())
    outside = database.parent / ".." / "out"
    outside.mkdir(mode=0o777, exist_ok=True)
    outside.chmod(0o777)
    words = [("status", database), ("check", database), ("compare", database),
             ("sql", database, "SELECT count(*) FROM crash"),
             ("report", database, "--output", outside / f"{database.parent.name}.html")]
    said = [run(*each, colleague=True).stdout for each in words]
    crash = run("sql", database, "SELECT min(id) FROM crash", "--format", "csv",
                colleague=True).stdout.split()[-1]
    run("crash", "--from", database, "--crash", crash, colleague=True)
    after = sorted((path.name, path.read_bytes()) for path in database.parent.iterdir())
    must(before == after, f"{database.parent.name}: reading changed the folder: "
         f"{[name for name, _ in before]}, then {[name for name, _ in after]}")
    return said[0]


def log_mode(database):
    return pathlib.Path(database).read_bytes()[18:20] == b"\x02\x02"


def finished_is_one_file(database):
    must(sorted(path.name for path in work.glob("study.db*")) == ["study.db"], "files beside a finished one")
    must(not log_mode(database), "a finished database is in WAL mode")
    read_all(folder("readonly", database, 0o555, 0o444))
    read_all(folder("readonly file", database, 0o755 if other_user else 0o555, 0o444))


def owner_is_not_shut_out(database):
    """In a folder that all may write to, with a database that only its owner may: as it was left by
    earlier versions or a killed run, and while it is written."""
    left = folder("left", database, 0o777, 0o644)
    with sqlite3.connect(left) as owner:
        owner.execute("PRAGMA journal_mode=WAL")
    owner.close()
    must(log_mode(left), "this test needs WAL mode")
    if other_user:
        read_all(left)
    owner = sqlite3.connect(left)
    owner.execute("CREATE TABLE note (t TEXT)")
    owner.execute("INSERT INTO note VALUES ('now')")
    owner.commit()
    if other_user:
        found = run("sql", left, "SELECT t FROM note", "--format", "csv", colleague=True).stdout
        must(found.split() == ["t", "now"], f"what is written meanwhile is not seen: {found}")
        must(all(path.stat().st_uid == os.geteuid() for path in left.parent.iterdir()),
             "a reader left files of its own")
    owner.execute("INSERT INTO note VALUES ('later')")
    owner.commit()
    return owner


def a_lost_log_is_told(database, owner):
    """The log of a killed run without its index, where nothing can be written."""
    live = work / "left" / "s.db"
    lost = folder("lost", live, 0o555, 0o444)
    lost.parent.chmod(0o755)
    (lost.parent / "s.db-shm").unlink()
    lost.parent.chmod(0o555)
    said = run("status", lost, expect=2, colleague=True).stderr
    must("unfinished log" in said and "check --upgrade" in said, said)
    # With its index it is read.
    whole = folder("whole", live, 0o555, 0o444)
    found = run("sql", whole, "SELECT count(*) FROM note", "--format", "csv", colleague=True).stdout
    must(found.split()[-1] == "2", found)
    # Its owner takes it in.
    lost.parent.chmod(0o755)
    for path in lost.parent.iterdir():
        path.chmod(0o644)
    run("check", lost, "--upgrade")
    must(not log_mode(lost) and [path.name for path in lost.parent.iterdir()] == ["s.db"], "not taken in")
    must(sqlite3.connect(lost).execute("SELECT count(*) FROM note").fetchone() == (2,), "the log is lost")
    owner.close()


def a_reader_delays_nobody(database):
    """While somebody reads, the last writer ends all the same, and says what stays."""
    reader = sqlite3.connect(database, isolation_level=None)
    reader.execute("PRAGMA journal_mode=WAL")
    reader.execute("BEGIN")
    reader.execute("SELECT count(*) FROM crash").fetchone()
    said = run("check", database, "--upgrade").stderr
    must("is read by others" in said, said)
    reader.execute("COMMIT")
    reader.close()
    run("check", database, "--upgrade")
    must(not log_mode(database), "WAL mode stays after the reader left")


def merging_leaves_no_stub(database):
    """A merge that fails creates nothing, one into a database that is there leaves it as it is."""
    (work / "text.db").write_text("no database")
    other = work / "other.db"
    (work / "list.csv").write_text(LIST.replace("50,40", "51,40"))
    run("assess", "--configurations", "list.csv", "--db", other)
    for words in ([work / "text.db"], [work / "absent.db"], [database, work / "text.db"], [database, other]):
        before = sorted(path.name for path in work.iterdir())
        said = run("merge", "new.db", *words, expect=2).stderr
        must("new.db is not created" in said, said)
        must(before == sorted(path.name for path in work.iterdir()), f"merge of {words} left files")
    run("merge", "new.db", database)
    content = (work / "new.db").read_bytes()
    rows = sqlite3.connect(work / "new.db").execute("SELECT count(*) FROM crash").fetchone()
    said = run("merge", "new.db", other, expect=2).stderr
    must("not created" not in said, said)
    must(rows == sqlite3.connect(work / "new.db").execute("SELECT count(*) FROM crash").fetchone() and
         len(content) == (work / "new.db").stat().st_size, "a failed merge changed what was there")


def network_is_told(database):
    if arguments.calls is None:
        return
    network = {"LD_PRELOAD": arguments.calls}
    said = run("merge", "onto_network.db", database, environment=network).stderr
    must("network file system (NFS)" in said and "--shard" in said, said)
    must("network" not in run("status", database, environment=network).stderr, "told of a finished one")
    with sqlite3.connect(work / "onto_network.db") as writer:
        writer.execute("PRAGMA journal_mode=WAL")
        said = run("status", "onto_network.db", environment=network).stderr
        must("is not finished" in said, said)


try:
    (work / "list.csv").write_text(LIST)
    study = work / "study.db"
    run("assess", "--configurations", "list.csv", "--db", study)
    finished_is_one_file(study)
    a_lost_log_is_told(study, owner_is_not_shut_out(study))
    a_reader_delays_nobody(study)
    merging_leaves_no_stub(study)
    network_is_told(study)
    if not other_user:
        print("not run as root: a database that another user may write to was not tried")
finally:
    for path in work.rglob("*"):
        if path.is_dir():
            path.chmod(0o755)
    shutil.rmtree(work)
