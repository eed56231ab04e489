# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts.py SOURCE: the scripts of reports by eslint (Debian's) with the profile eslint.json: its
recommended rules and a few more. The page's script is checked as it is embedded, its parts one
after the other (src/report/CMakeLists.txt), and every complaint named by part and line. Ends with
status 1 if there is one, 77 where eslint is not installed."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
source = pathlib.Path(sys.argv[1]).resolve()
reports = source / "reports"


def page_parts():
    """The parts of the page's script in their order."""
    lists = (source / "src/report/CMakeLists.txt").read_text()
    names = re.search(r"set\(page_script ([\w\s]+)\)", lists).group(1).split()
    return [reports / "page" / f"{name}.js" for name in names]


def joined(parts):
    """Their text as the page runs it, and (part, line) of each of its lines."""
    lines, places = ['"use strict";', "(function () {"], [(source / "reports/page.html", 0)] * 2
    for part in parts:
        text = part.read_text().splitlines()
        lines += text
        places += [(part, number) for number in range(1, len(text) + 1)]
    lines.append("})();")
    return "\n".join(lines) + "\n", places + [(source / "reports/page.html", 0)]


def complaints(name, text):
    """(line, column, what) of each; eslint reads files below its working folder only."""
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / name).write_text(text)
        # Debian's eslint finds its modules by itself under Debian's node only.
        found = subprocess.run(["eslint", "--no-eslintrc", "-c", str(source / "tests/lint/eslint.json"), "-f", "json", name],
                               cwd=folder, capture_output=True, text=True,
                               env={**os.environ, "NODE_PATH": "/usr/share/nodejs"})
        if found.returncode > 1 or not found.stdout.strip():
            sys.exit(f"eslint: {found.stderr.strip()}")
        return [(m["line"], m["column"], f'{m["message"]} [{m["ruleId"]}]')
                for file in json.loads(found.stdout) for m in file["messages"]]


def main():
    if shutil.which("eslint") is None:
        print("eslint is not installed (Debian: eslint): the scripts of reports are not checked")
        return SKIPPED
    parts = page_parts()
    unused = set((reports / "page").glob("*.js")) - set(parts)
    said = [f"{p.relative_to(source)}:1: is in no page" for p in sorted(unused)]
    text, places = joined(parts)
    for line, column, what in complaints("page.js", text):
        part, number = places[line - 1]
        said.append(f"{part.relative_to(source)}:{number}:{column}: {what}")
    for script in sorted(reports.glob("*.js")):
        said += [f"{script.relative_to(source)}:{line}:{column}: {what}"
                 for line, column, what in complaints(script.name, script.read_text())]
    print("\n".join(said) if said else f"{len(parts)} parts of the page and {len(list(reports.glob('*.js')))} more scripts: nothing to say")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
