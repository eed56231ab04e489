# SPDX-License-Identifier: GPL-3.0-or-later
"""Names in files and databases never act: no command runs, no escape sequence or forged line reaches
a terminal, no cell of a CSV is a formula, whatever the name and wherever it is shown."""
import csv
import io
import json
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

import hostile

parser = hostile.parser(__doc__, "db", "network")
parser.add_argument("--few", action="store_true", help="every fourth name")
a = parser.parse_args()

NAMES = ("`touch owned`", "$(touch owned)", "x\"; system \"touch owned\"; #", "'; touch owned; '",
         "\x1b]0;owned\x07\x1b[2J", "a\ncrashpulse: error: forged\n!touch owned", "\x9b31m",
         "=HYPERLINK(\"http://x\")", "+1+cmd|' /C calc'!A0", "-2+3", "@SUM(1)", "\u202eabc",
         "</script><script>document.title='owned'</script>", "%n%s%n", "<img src=x onerror=alert(1)>")
TEXTS = (("variant", "name"), ("scenario", "name"), ("study", "name"), ("risk_function", "name"),
         ("risk_function", "level"), ("risk_function", "source"))


def run(folder, *words, expect=(0,)):
    result = hostile.run(a.crashpulse, folder, *words, expect=expect)
    if (folder / "owned").exists():
        sys.exit(f"{words}: a name was run")
    return result


def check_terminal(words, out):
    """Neither controls nor lines that a name brought along."""
    text = out.decode("utf-8")
    if hostile.control_characters(text):
        sys.exit(f"{words}: control characters {hostile.control_characters(text)} in {text!r}")
    if any(line.startswith(("crashpulse: error: forged", "!touch")) for line in text.splitlines()):
        sys.exit(f"{words}: a forged line in {text!r}")


shown = 0
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for name_given in NAMES[::4] if a.few else NAMES:
        # One row of each table takes the name.
        shutil.copy(a.db, folder / "study.db")
        connection = sqlite3.connect(folder / "study.db")
        connection.execute("PRAGMA foreign_keys=OFF")
        for table, column in TEXTS:
            key = "id" if table in ("variant", "scenario", "study") else "source"
            connection.execute(f"UPDATE {table} SET {column} = ? WHERE {key} = (SELECT max({key}) "
                               f"FROM {table})", (name_given,))
        connection.execute("UPDATE replication SET status='failed' WHERE id = (SELECT max(id) FROM "
                           "replication)")
        connection.commit()
        connection.close()
        for words in (["compare", "study.db"], ["status", "study.db"],
                      ["sql", "study.db", "SELECT name, level, source FROM risk_function"],
                      ["compare", "study.db", "--baseline", name_given + "?"],
                      ["plot", "study.db", "olc", "--output", "f.svg"],
                      ["plot", "study.db", "benefit", "--output", "f.svg"],
                      ["report", "study.db", "--output", "f.html"]):
            result = run(folder, *words, expect=(2,) if "--baseline" in words else (0,))
            check_terminal(words, result.stdout)
            check_terminal(words, result.stderr)
            shown += 1
        # A table of texts as CSV and JSON: no formula; all bytes.
        out = run(folder, "sql", "study.db", "SELECT name, 1 FROM study", "-f", "csv").stdout.decode()
        cell = list(csv.reader(io.StringIO(out, newline="")))[1][0]
        assert cell == ("'" + name_given if name_given[0] in "=+-@" else name_given), (cell, name_given)
        out = run(folder, "sql", "study.db", "SELECT name FROM study", "-f", "json").stdout
        assert json.loads(out)[0]["name"] == name_given
        shown += 2
    # Numbers stay numbers.
    out = run(folder, "sql", "study.db", "SELECT -1.5, '-1.5', '-', '='", "-f", "csv").stdout.decode()
    assert out.splitlines()[1] == "-1.5,-1.5,-,=", out

    # A study's names on the way to scripts of a cluster.
    shutil.copytree(a.network, folder / "net")
    (folder / "study.yaml").write_text(hostile.study())
    for path in ("x\ntouch owned\n.db", "x\r.db", "x\x1b.db", "x'$(touch owned)'.db"):
        result = run(folder, "submit", "study.yaml", "--slurm", "--dry-run", "--db", path, expect=(2,))
        assert b"cannot be submitted" in result.stderr, result.stderr
        check_terminal("submit", result.stderr)
        assert not list(folder.glob("*.slurm"))
        shown += 1
    # A file is called what it is called, also by the stock shell.
    connection = sqlite3.connect(folder / "study.db")
    connection.execute("PRAGMA journal_mode=DELETE")
    connection.close()
    for odd in ("file:study.db?mode=memory", "-init", ":memory:", "file:x"):
        shutil.copy(folder / "study.db", folder / odd)
        result = run(folder, "sql", "-f", "csv", "--", odd, "SELECT count(*) FROM replication")
        assert result.stdout.splitlines()[1] != b"0", odd
        # The shell loads our extension: with sanitizers their runtime comes first.
        environment = dict(os.environ, LD_PRELOAD=os.environ.get("CRASHPULSE_PRELOAD", ""))
        result = subprocess.run([a.crashpulse, "sql", "-f", "csv", "--", odd], cwd=folder,
                                env=environment, input=b"SELECT count(*) FROM replication;",
                                capture_output=True)
        assert result.returncode == 0 and int(result.stdout.split()[1]) > 0, (odd, result)
        shown += 2
    result = run(folder, "merge", "--", "file:new.db?mode=memory", "file:x")
    assert (folder / "file:new.db?mode=memory").stat().st_size > 0
    shown += 1
print(f"{shown} times a hostile name was shown, nothing acted")
