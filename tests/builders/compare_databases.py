#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_databases.py ONE TWO: whether two databases hold the same rows, to the bit, apart from who
made them and when (PROVENANCE). Says how many rows are the same, or per table what only one of them
has; exit code 1 when they differ, 2 when one cannot be read."""
import pathlib
import sqlite3
import sys

# Table: columns left out; None: the whole table. Outcome and message of attempts are compared by
# nobody: a study that was disturbed has more of them.
PROVENANCE = {
    "attempt": None,
    "merge_source": None,
    "replication": {"crashpulse_version"},
    "background_run": {"crashpulse_version"},
    "comparison": {"crashpulse_version"},
}
SHOWN = 1  # differing rows of a table, from each


def exact(value):
    """A value as text that no other value has: 1 is not 1.0, nor '1'."""
    return value.hex() if isinstance(value, float) else repr(value)


def read(db):
    """{table: (columns, sorted rows as texts)} without provenance."""
    connection = sqlite3.connect(f"{pathlib.Path(db).resolve().as_uri()}?mode=ro", uri=True, timeout=60)
    found = {}
    try:
        tables = connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT "
                                    "LIKE 'sqlite_%' ORDER BY name").fetchall()
        for (table,) in tables:
            left_out = PROVENANCE.get(table, set())
            if left_out is None:
                continue
            columns = [row[1] for row in connection.execute(f'PRAGMA table_info("{table}")')
                       if row[1] not in left_out]
            names = ", ".join(f'"{name}"' for name in columns)
            found[table] = columns, sorted(tuple(map(exact, row)) for row in connection.execute(
                f'SELECT {names} FROM "{table}"'))
    finally:
        connection.close()
    return found


def first_difference(columns, only_one, only_two):
    """The column in which the first rows of both differ, with its two values."""
    for name, one, two in zip(columns, only_one[0], only_two[0]):
        if one != two:
            return f"{name}: {one[:60]} | {two[:60]}"
    return "how often a row is there"


def differences(one, two):
    """One line for each thing that differs; none: they are the same."""
    a, b = read(one), read(two)
    lines = [f"{table}: only in {one if table in a else two}" for table in sorted(a.keys() ^ b.keys())]
    for table in sorted(a.keys() & b.keys()):
        (columns, rows_a), (others, rows_b) = a[table], b[table]
        if columns != others:
            lines.append(f"{table}: columns {columns} | {others}")
            continue
        if rows_a == rows_b:
            continue
        set_a, set_b = set(rows_a), set(rows_b)
        only_a = [row for row in rows_a if row not in set_b]
        only_b = [row for row in rows_b if row not in set_a]
        lines.append(f"{table}: {len(rows_a)} | {len(rows_b)} rows, {len(only_a)} | {len(only_b)} of "
                     f"them only there")
        if only_a and only_b:
            lines.append("  " + first_difference(columns, only_a, only_b))
        for where, only in ((one, only_a), (two, only_b)):
            lines += [f"  only in {where}: {' '.join(row)[:160]}" for row in only[:SHOWN]]
    return lines


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        lines = differences(*arguments)
        total = sum(len(rows) for _, rows in read(arguments[0]).values())
    except sqlite3.Error as error:
        print(f"{' or '.join(arguments)}: {error}", file=sys.stderr)
        return 2
    print("\n".join(lines) if lines else f"the same {total} rows")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
