# SPDX-License-Identifier: GPL-3.0-or-later
"""Manual pages and completion: every command and every option that argp knows stands in both; pages are clean roff."""
import argparse
import pathlib
import re
import shutil
import subprocess

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--manual", required=True, type=pathlib.Path)
arguments = parser.parse_args()


def help_of(*words):
    return subprocess.run([arguments.crashpulse, *words, "--help"], capture_output=True, text=True, check=True).stdout


def complete(*words):
    script = (f". '{arguments.manual}/crashpulse.bash'; COMP_WORDS=({' '.join(repr(w) for w in words)}); "
              f"COMP_CWORD={len(words) - 1}; _crashpulse; echo \"${{COMPREPLY[@]}}\"")
    return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout.split()


commands = [name for name in re.findall(r"^  (\S+) +\S.*$", help_of(), re.M) if re.fullmatch(r"[a-z]+", name)
            and name != "crashpulse"]
assert len(commands) >= 18, commands
assert set(commands) <= set(complete("crashpulse", "")), complete("crashpulse", "")
assert complete("crashpulse", "comp") == ["compare"]
assert set(complete("crashpulse", "compare", "x.db", "--format", "")) == {"table", "json", "csv"}
options = 0
for command in commands:
    page = (arguments.manual / "man1" / f"crashpulse-{command}.1").read_text().replace("\\-", "-")
    completed = complete("crashpulse", command, "--")
    # -f is the format wherever there is one.
    short = re.findall(r"^ {1,6}-f, (--[a-z-]+)", help_of(command), re.M)
    assert short == (["--format"] if "--format=" in help_of(command) else []), (command, short)
    for option in re.findall(r"^ {1,6}(?:-\S, )?(--[a-z0-9-]+)", help_of(command), re.M):
        options += 1
        assert re.search(rf"^\.TP\n.*{option}\b", page, re.M), (command, option)
        assert option in completed, (command, option, completed)
    assert "--quiet" in completed, completed
assert options > 60, options

if shutil.which("man"):
    for page in sorted((arguments.manual / "man1").glob("*.1")):
        shown = subprocess.run(["man", "--warnings", "-l", page], capture_output=True, text=True,
                               env={"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "MANWIDTH": "100", "MANPAGER": "cat"})
        if "has been minimized" in shown.stdout + shown.stderr:
            print("this system's man shows no pages: they are not formatted")
            break
        assert shown.returncode == 0 and shown.stderr == "" and "NAME" in shown.stdout, (page, shown.stderr)
