# SPDX-License-Identifier: GPL-3.0-or-later
"""`crashpulse submit --slurm` on a real Slurm of one node: an array of four tasks and the merge that
depends on it give the rows of a run on one machine; a task that is killed is made up for."""
import argparse
import pathlib
import sqlite3
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cluster
import crossing_study

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--network", required=True)
arguments = parser.parse_args()

reason = cluster.missing()
if reason:
    print(f"skipped: {reason}")
    sys.exit(77)


def submit(slurm, study, db):
    result = slurm.run(arguments.crashpulse, "submit", str(study), "--slurm", "--db", str(db),
                       "--shards", "4")
    array, merge = result.stdout.split()
    slurm.wait("the jobs", lambda: not slurm.run("squeue", "-h").stdout.strip())
    return array, merge


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    folder.chmod(0o755)  # munged runs as a user of its own
    study = crossing_study.write(folder, arguments.network, replications=4)
    alone = folder / "alone.db"
    crossing_study.run(arguments.crashpulse, "run", study, "--db", alone)
    (folder / "cluster").mkdir()
    with cluster.Cluster(folder / "cluster") as slurm:
        db = folder / "study.db"
        array, merge = submit(slurm, study, db)
        logs = sorted((folder / "study.db.slurm").glob("*.log"))
        assert [log.name for log in logs] == ["merge.log"] + [f"shard_{k}.log" for k in (1, 2, 3, 4)]
        text = logs[0].read_text()
        assert "8 of 8 replications done" in text, "".join(log.read_text() for log in logs)
        crossing_study.assert_same(db, alone)
        sources = sqlite3.connect(db).execute("SELECT replications FROM merge_source").fetchall()
        assert sources == [(2,)] * 4, sources

        # A shard is lost with its disk: submitting again runs that share only.
        (folder / "study.db.slurm" / "shard_3.db").unlink()
        again = folder / "study.db"
        again.unlink()
        submit(slurm, study, db)
        crossing_study.assert_same(db, alone)
        attempts = sqlite3.connect(folder / "study.db.slurm" / "shard_1.db").execute(
            "SELECT count(*) FROM attempt").fetchone()
        assert attempts == (2,), attempts
        print(f"array {array} and merge {merge}: the rows of a run on one machine")
