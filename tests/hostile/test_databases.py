# SPDX-License-Identifier: GPL-3.0-or-later
"""Databases from strangers: what was put into the schema does not run and does not answer in place of
ours, and whatever stands in the rows gives a result or a message, never the end by a signal, an
endless run or another exit code. --samples N: so many cells of the matrix of rows; 0: all."""
import os
import pathlib
import random
import shutil
import sqlite3
import subprocess
import sys
import tempfile

import hostile

parser = hostile.parser(__doc__, "db", "samples")
parser.add_argument("--few", action="store_true", help="of the commands on foreign schemas some")
a = parser.parse_args()

LIST = hostile.LIST + "two,suv,van,30,60,300,10\n"
COMMANDS = (["compare"], ["status"], ["check"], ["report", "--output", "out.html"],
            ["plot", "olc", "--output", "out.svg"], ["sql", "SELECT * FROM olc_by_variant"],
            ["run", "study.yaml", "--db"], ["merge"], ["crash", "--crash", "1", "--from"])


def run(folder, *words, expect=None):
    return hostile.run(a.crashpulse, folder, *words, limit_s=60,
                       expect=None if expect is None else (expect,))


def change(path, sql):
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA foreign_keys=OFF")
    connection.executescript(sql)
    connection.close()


def content(path):
    connection = sqlite3.connect(path)
    found = list(connection.iterdump())
    connection.close()
    return found


def words_for(command, db):
    """The database's name in its place: last where the option before it wants it, else first."""
    if command[-1] in ("--db", "--from"):
        return [*command, db]
    return [command[0], db, *command[1:]] if command[0] != "merge" else ["merge", "sum.db", db]


# Schemas that are not ours.
def rewritten(name, old, new):
    return (f"PRAGMA writable_schema=ON; UPDATE sqlite_schema SET sql = replace(sql, '{old}', '{new}') "
            f"WHERE name = '{name}'; PRAGMA writable_schema=OFF;")


EVIL = "BEGIN DELETE FROM pulse; DELETE FROM crash_vehicle; END;"
FOREIGN = {
    "a trigger on what compare writes":
        f"CREATE TRIGGER evil AFTER INSERT ON comparison {EVIL}",
    "a trigger on claims": f"CREATE TRIGGER evil AFTER UPDATE ON replication {EVIL}",
    "a table that is a view":
        "ALTER TABLE comparison_figure RENAME TO kept; CREATE VIEW comparison_figure AS SELECT * FROM kept; "
        f"CREATE TRIGGER evil INSTEAD OF INSERT ON comparison_figure {EVIL}",
    "a trigger of ours with another body":
        "DROP TRIGGER crash_stays; CREATE TRIGGER crash_stays BEFORE UPDATE OF id, replication_id, "
        f"crash_type ON crash {EVIL}",
    "a trigger of ours that is gone": "DROP TRIGGER crash_vehicle_copies",
    "an index of ours that is gone": "DROP INDEX crash_vehicle_olc",
    "a table with one more column": "ALTER TABLE pulse ADD COLUMN more INTEGER",
    "a table of ours that is gone": "DROP TABLE comparison_figure",
    "another default": rewritten("attempt", "NOT NULL", "NOT NULL DEFAULT 7"),
    "another program's": "PRAGMA application_id = 7",
    "a later version": "PRAGMA user_version = 999",
    "an earlier version that it is not": "PRAGMA user_version = 3",
}

tried = 0
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "study.yaml").write_text("study: s\n")
    (folder / "list.csv").write_text(LIST)
    run(folder, "assess", "--configurations", "list.csv", "--db", "list.db", expect=0)
    for what, sql in FOREIGN.items():
        db = folder / "foreign.db"
        shutil.copy(a.db, db)
        change(db, sql)
        before = content(db)
        for command in [COMMANDS[0], COMMANDS[7]] if a.few else COMMANDS:
            result = run(folder, *words_for(command, "foreign.db"))
            if result.returncode not in (1, 2) or (command[0] != "run" and result.returncode != 2):
                sys.exit(f"{what}: {command}: exit code {result.returncode}: {result.stderr}")
            tried += 1
        assert content(db) == before, what
        assert not (folder / "out.html").exists() and not (folder / "out.svg").exists(), what
        for path in folder.glob("*.db*"):
            if path.name != "list.db":
                path.unlink()

    # Views of ours that say something else are neither asked nor believed; those of the user stay.
    db = folder / "views.db"
    shutil.copy(a.db, db)
    right = run(folder, "sql", str(a.db), "SELECT * FROM olc_by_variant", "-f", "csv", expect=0).stdout
    change(db, "DROP VIEW olc_by_variant; CREATE VIEW olc_by_variant AS SELECT 'a lie' AS variant; "
               "CREATE VIEW mine AS SELECT count(*) AS n FROM crash; CREATE TABLE note (text); "
               "CREATE INDEX my_index ON crash (time_s);")
    for _ in range(2):
        found = run(folder, "sql", "views.db", "SELECT * FROM olc_by_variant", "-f", "csv", expect=0)
        assert found.stdout == right, found.stdout
        assert int(run(folder, "sql", "views.db", "SELECT n FROM mine", "-f", "csv",
                       expect=0).stdout.split()[1]) > 0
        run(folder, "compare", "views.db", expect=0)  # which writes
        tried += 3
    assert sqlite3.connect(db).execute("SELECT variant FROM olc_by_variant").fetchone() != ("a lie",)

    # A database is not merged into itself, by whatever name.
    shutil.copy(folder / "list.db", folder / "self.db")
    os.symlink("self.db", folder / "linked.db")
    os.link(folder / "self.db", folder / "twin.db")
    for words in (("./self.db", "self.db"), ("self.db", "linked.db"), ("twin.db", "self.db")):
        assert b"into itself" in run(folder, "merge", *words, expect=2).stderr
        tried += 1

    # Rows: every column of every table with what no program of ours writes.
    odd = ("1e308", "-1e308", "9e999", "-9e999", "-1", "0", "9223372036854775807",
           "-9223372036854775808", "1e-308", "'text'", "''", "x'00ff'", "NULL", "zeroblob(300)",
           "'[1e999,{\"a\":[]}]'", "'9e999'", "char(27, 10, 0, 65)")
    cells = []
    for source in (a.db, folder / "list.db"):
        connection = sqlite3.connect(source)
        tables = [row[0] for row in connection.execute(
            "SELECT name FROM sqlite_schema WHERE type='table' AND name NOT LIKE 'sqlite_%' AND "
            "name NOT LIKE 'comparison%'")]
        crash = connection.execute("SELECT min(id) FROM crash").fetchone()[0]
        for table in tables:
            if connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0] == 0:
                continue
            for column in connection.execute(f"PRAGMA table_xinfo({table})"):
                cells += [(source, crash, table, column[1], value) for value in odd
                          if not column[6]]
        connection.close()
    if a.samples:
        cells = random.Random(20).sample(cells, min(a.samples, len(cells)))
    db, matrix = folder / "rows.db", 0
    for source, crash, table, column, value in cells:
        shutil.copy(source, db)
        connection = sqlite3.connect(db)
        connection.execute("PRAGMA ignore_check_constraints=ON")
        connection.setconfig(sqlite3.SQLITE_DBCONFIG_ENABLE_TRIGGER, False) if hasattr(
            connection, "setconfig") else None
        try:
            connection.execute(f"UPDATE OR IGNORE {table} SET {column} = {value}")
            connection.commit()
        except sqlite3.Error:
            connection.close()
            continue
        connection.close()
        commands = [c for c in COMMANDS if c[0] in ("compare", "status", "check", "report", "plot")]
        if source != a.db:
            commands = [["crash", "--crash", str(crash), "--from"], ["check"], ["report", "--output",
                                                                               "out.html"]]
        for command in commands:
            what = f"{table}.{column} = {value}: {command}"
            try:
                result = run(folder, *words_for(command, "rows.db"))
            except subprocess.TimeoutExpired:
                sys.exit(f"{what}: no end in 60 s")
            if result.returncode not in (0, 1, 2):
                sys.exit(f"{what}: exit code {result.returncode}: {result.stderr[-500:]}")
            if result.returncode and not hostile.has_message(result.stderr.decode(errors="replace")):
                sys.exit(f"{what}: no message: {result.stderr}")
            if result.returncode == 0 and b"\x1b" in result.stdout:
                sys.exit(f"{what}: an escape sequence in {result.stdout}")
            matrix += 1
print(f"{tried} commands on foreign schemas, {matrix} on odd rows: nothing ran, nothing ended by a signal")
