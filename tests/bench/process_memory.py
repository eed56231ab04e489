# SPDX-License-Identifier: GPL-3.0-or-later
"""Resident memory of a running program, as the kernel tells it in /proc: all of it, and what of it is
anonymous, that is the process's own. The rest are pages of program and library files, which all processes
that load them share."""
import collections
import pathlib
import re

Memory = collections.namedtuple("Memory", "resident_mb anonymous_mb peak_mb")


def family_of(process):
    """A process and all that descend from it."""
    parent_of = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            parent_of[int(stat.parent.name)] = int(stat.read_text().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue  # it has ended
    family = {process}
    while True:
        children = {p for p, parent in parent_of.items() if parent in family} - family
        if not children:
            return family
        family |= children


def memory_of(process, name=""):
    """Of one process; zeros when it has ended or its program's name does not begin with this."""
    try:
        text = pathlib.Path(f"/proc/{process}/status").read_text()
    except OSError:
        text = ""
    fields = dict(re.findall(r"^(\w+):\s+(\S+)", text, re.MULTILINE))
    if not fields.get("Name", "").startswith(name):
        fields = {}
    return Memory(*(float(fields.get(key, 0)) / 1024 for key in ("VmRSS", "RssAnon", "VmHWM")))


def largest_of(process, name=""):
    """Of the largest process of a family whose program's name (its first 15 bytes) begins like this."""
    return max(memory_of(member, name) for member in family_of(process))
