# SPDX-License-Identifier: GPL-3.0-or-later
"""What compilers and checkers say without running anything: clang's warnings over every source (the
project is built by gcc), clang-tidy by .clang-tidy, cppcheck without those of cppcheck.txt. Ends with
status 1 if there is a single word. --all: clang-tidy over the C++ bridges too, whose libraries take a
minute."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys
import time

parser = argparse.ArgumentParser()
parser.add_argument("--source", required=True)
parser.add_argument("--build", required=True, help="with compile_commands.json")
parser.add_argument("--all", action="store_true")
a = parser.parse_args()
source, build = pathlib.Path(a.source).resolve(), pathlib.Path(a.build).resolve()
commands = {}
for entry in json.loads((build / "compile_commands.json").read_text()):
    file = pathlib.Path(entry["file"]).resolve()
    if source in file.parents and build not in file.parents:  # generated ones are data
        commands[file] = entry


def called(*words, cwd=build):
    result = subprocess.run(list(map(str, words)), cwd=cwd, capture_output=True, text=True)
    return (result.stdout + result.stderr) if result.returncode else ""


def syntax(file):
    words = [w for w in shlex.split(commands[file]["command"]) if not w.endswith("ccache")]
    at = words.index("-o")
    del words[at:at + 2]
    words[0] = "clang++" if file.suffix == ".cpp" else "clang"
    return called(*words, "-fsyntax-only", cwd=commands[file]["directory"])


# clang-tidy gives clang's own warnings too.
def tidy(file):
    return called("clang-tidy", "-p", build, "--quiet", file)


def cppcheck(files):
    return called("cppcheck", "-q", f"-j{os.cpu_count()}", "--std=c11", "--error-exitcode=1",
                  "--enable=warning,performance,portability", f"-I{source}/src",
                  f"--suppressions-list={source}/tests/lint/cppcheck.txt", *files)


of_src = [f for f in commands if source / "src" in f.parents]
tidied = [f for f in of_src if a.all or f.suffix == ".c"]
said, began = [], time.monotonic()
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    # The longest first.
    for words in pool.map(tidy, sorted(tidied, key=lambda f: (f.suffix != ".cpp", -f.stat().st_size))):
        said += [words] if words else []
    print(f"clang-tidy: {len(tidied)} files, {time.monotonic() - began:.0f} s", flush=True)
    rest = [f for f in commands if f not in tidied]
    for words in pool.map(syntax, rest):
        said += [words] if words else []
    print(f"clang: {len(rest)} more files, {time.monotonic() - began:.0f} s", flush=True)
words = cppcheck([f for f in of_src if f.suffix == ".c"])
said += [words] if words else []
print(f"cppcheck: {time.monotonic() - began:.0f} s")
print("\n".join(said) if said else "nothing said")
sys.exit(1 if said or not tidied else 0)
