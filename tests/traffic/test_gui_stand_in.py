# SPDX-License-Identifier: GPL-3.0-or-later
"""The stand-in for the libraries of SUMO's window: a worker loads it in their place and none of what they
need, and a function of theirs that is called all the same names itself and ends the process."""
import argparse
import pathlib
import re
import signal
import subprocess
import sys

parser = argparse.ArgumentParser()
parser.add_argument("--worker", required=True)
parser.add_argument("--sumo", required=True)
parser.add_argument("--folder", required=True, type=pathlib.Path, help="of the stand-in")
parser.add_argument("--source", required=True, type=pathlib.Path, help="of the stand-in")
arguments = parser.parse_args()
LIBRARY = arguments.folder / "libsumo_gui_stand_in.so"


def loaded(program):
    text = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
    return dict(re.findall(r"^\s*(\S+) => (/\S+)", text, re.MULTILINE))


links = [path.name for path in arguments.folder.iterdir() if path.is_symlink()]
worker, sumo = loaded(arguments.worker), loaded(arguments.sumo)
# The loader, and so ldd, has one file but once, under the first of its names.
places = {pathlib.Path(worker[name]).resolve() for name in links if name in worker}
assert not set(links) & set(sumo), f"plain sumo needs {set(links) & set(sumo)}"
assert places == ({LIBRARY.resolve()} if links else set()), places
# Besides plain sumo's, the worker needs some ten libraries of its own; the window's are 150.
own = set(worker) - set(sumo) - set(links)
assert len(own) < 30, sorted(own)

functions = re.findall(r'left_out\("(\w+)", "(\S+?)"\)', arguments.source.read_text())
if not links:
    print("this libsumocpp needs no library of a window")
    sys.exit(0)
assert len(functions) > 10, functions
name, home = functions[-1]
script = f"import ctypes; getattr(ctypes.CDLL('{LIBRARY}'), '{name}')()"
result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
assert result.returncode == -signal.SIGABRT, result
assert f"SUMO wants {name} of {home}, a library of its window" in result.stderr, result.stderr
