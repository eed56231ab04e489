#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""gui_stand_in.py SUMO LIBSUMOCPP READELF SOURCE FOLDER STAND_IN: for the libraries of SUMO's window.

Debian's libsumocpp is built with the GUI: OpenSceneGraph, GDAL, ffmpeg and what those need come along
into every process that uses it, some 150 libraries, although no simulation without a window calls
them. Left out is what LIBSUMOCPP needs and the program SUMO, which simulates the same without a
window, does not. Writes SOURCE.c, which defines every symbol that LIBSUMOCPP wants of those libraries (a
function that is called all the same says so and aborts), SOURCE.map with the versions of the symbols,
and in FOLDER the names of the libraries as links to STAND_IN, the library to be built from the two."""
import collections
import pathlib
import re
import subprocess
import sys

Symbol = collections.namedtuple("Symbol", "name version kind size bind is_defined")


def output_of(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True,
                          env={"LC_ALL": "C", "PATH": "/usr/bin:/bin"}).stdout


def libraries_of(path):
    """Paths of all libraries that a program or library loads, by name."""
    pairs = re.findall(r"^\s*(\S+) => (/\S+)", output_of("ldd", path), re.MULTILINE)
    return dict(pairs)


def needed_by(path):
    return re.findall(r"\(NEEDED\).*\[(.+)\]", output_of(readelf, "-dW", path))


def symbols_of(path):
    row = re.compile(r"^ *\d+: +[0-9a-f]+ +(\S+) +(\w+) +(\w+) +\w+ +(\S+) +([^\s@]+)(?:@@?(\S+))?",
                     re.MULTILINE)
    for size, kind, bind, section, name, version in row.findall(output_of(readelf, "-W", "--dyn-syms", path)):
        yield Symbol(name, version, kind, int(size, 0), bind, section != "UND")


sumo, library, readelf, source, folder, stand_in = sys.argv[1:7]
kept, all_needed = libraries_of(sumo), libraries_of(library)
names = [name for name in needed_by(library) if name not in kept]
there = {symbol.name for path in kept.values() for symbol in symbols_of(path) if symbol.is_defined}
offered = {}
for name, path in all_needed.items():
    if name not in kept:
        for symbol in symbols_of(path):
            if symbol.is_defined:
                offered.setdefault(symbol.name, (symbol, name))

# A line of C for each symbol, and the names of each version.
lines, of_version = [], collections.defaultdict(list)
for wanted in symbols_of(library):
    if wanted.is_defined or wanted.bind == "WEAK" or wanted.name in there:
        continue
    if wanted.name not in offered:
        sys.exit(f"{library}: no library it needs has its symbol {wanted.name}")
    symbol, home = offered[wanted.name]
    if symbol.kind in ("FUNC", "IFUNC"):
        lines.append(f'void {symbol.name}(void) {{ left_out("{symbol.name}", "{home}"); }}')
    elif symbol.kind == "OBJECT":
        lines.append(f"_Alignas(32) char {symbol.name}[{max(symbol.size, 1)}];")
    else:
        sys.exit(f"{home}: symbol {symbol.name} is of kind {symbol.kind}, not known here")
    if wanted.version:
        of_version[wanted.version].append(wanted.name)

pathlib.Path(source + ".c").write_text(f"""/* Made by gui_stand_in.py of {library}. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void say(const char *text)
{{
    if (write(2, text, strlen(text)) < 0)
        abort();
}}

static void left_out(const char *symbol, const char *library)
{{
    say("SUMO wants ");
    say(symbol);
    say(" of ");
    say(library);
    say(", a library of its window, left out here: build with -DCRASHPULSE_SUMO_GUI=ON\\n");
    abort();
}}

""" + "\n".join(lines) + "\n")
pathlib.Path(source + ".map").write_text("".join(
    f"{version} {{\n    " + "\n    ".join(f"{name};" for name in sorted(symbols)) + "\n};\n"
    for version, symbols in sorted(of_version.items())) or "{ *; };\n")
# Links of an earlier libsumocpp would hide libraries that are needed now.
folder = pathlib.Path(folder)
folder.mkdir(parents=True, exist_ok=True)
for old in folder.iterdir():
    if old.is_symlink():
        old.unlink()
for name in names:
    (folder / name).symlink_to(stand_in)
