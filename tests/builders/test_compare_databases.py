# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_databases.py sees whatever differs between two databases, and nothing else."""
import pathlib
import sqlite3
import tempfile

import compare_databases

PLAIN = """
CREATE TABLE crash (id INTEGER, time_s REAL, note TEXT, pulse BLOB);
CREATE TABLE replication (id INTEGER, crashpulse_version TEXT);
CREATE TABLE attempt (pid INTEGER);
INSERT INTO crash VALUES (1, 0.1, 'x', x'00ff'), (2, 0.0, NULL, NULL), (2, 0.0, NULL, NULL);
INSERT INTO replication VALUES (1, '0.1.0');
INSERT INTO attempt VALUES (1);
"""
# What is changed, and what the lines about it begin with and have in them; None: the same.
CASES = [
    ("", None, None),
    ("UPDATE attempt SET pid = 2", None, None),
    ("UPDATE replication SET crashpulse_version = '0.2.0'", None, None),
    ("UPDATE replication SET id = 2", "replication", "id: 1 | 2"),
    ("UPDATE crash SET time_s = 0.1 + 1.4e-17 WHERE id = 1", "crash", "time_s: "),
    ("UPDATE crash SET note = 1 WHERE id = 1", "crash", "note: 'x' | '1'"),
    ("UPDATE crash SET note = 'y' WHERE id = 1", "crash", "note: 'x' | 'y'"),
    ("UPDATE crash SET note = '' WHERE id = 2", "crash", "note: None | ''"),
    ("UPDATE crash SET pulse = x'00fe' WHERE id = 1", "crash", "pulse: "),
    ("DELETE FROM crash WHERE rowid = 3", "crash", "3 | 2 rows"),
    ("CREATE TABLE more (id INTEGER)", "more", "only in"),
    ("ALTER TABLE crash ADD COLUMN more REAL", "crash", "columns"),
]


def make(path, change):
    connection = sqlite3.connect(path)
    connection.executescript(PLAIN + change)
    connection.close()


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    make(folder / "plain.db", "")
    for number, (change, table, words) in enumerate(CASES):
        other = folder / f"{number}.db"
        make(other, change)
        lines = compare_databases.differences(folder / "plain.db", other)
        status = compare_databases.main([str(folder / "plain.db"), str(other)])
        if table is None:
            assert not lines and status == 0, (change, lines)
        else:
            assert status == 1 and lines[0].startswith(f"{table}: "), (change, lines)
            assert words in "\n".join(lines), (change, lines)
    assert compare_databases.main([str(folder / "plain.db"), str(folder / "none.db")]) == 2
print(f"{len(CASES)} pairs of databases told apart")
