# SPDX-License-Identifier: GPL-3.0-or-later
"""The house's own rules: include law, no circles among the files of a room, licence lines, no
file-scope mutable state, C++ only in bridges, SUMO's bridge behind the traffic, lengths of files, a test for every file. Prints every
breach as file:line and ends with status 1 if there is one. An exception stands in a list beside
this file, with its reason; one that is no longer needed is a breach too."""
import pathlib
import re
import sys

LONG, LONGEST = 400, 600  # lines: from the first on a reason is needed, the second is the end
BRIDGES = ("sumo_bridge.cpp", "sumo_messages.cpp", "sumo_vehicles.cpp", "sumo_road_relation.cpp", "sumo_roads.cpp",
           "optimiser.cpp")


def read_list(path):
    """Lines "what: value" of a list, each with its number; '#' begins a comment."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.strip() and not line.lstrip().startswith("#"):
            name, _, value = line.partition(":")
            yield number, name.strip(), value.strip()


class House:
    def __init__(self, source):
        self.source = source
        self.lists = source / "tests/house"
        self.breaches = []
        self.files = sorted(p for suffix in ("*.c", "*.h", "*.cpp") for p in (source / "src").rglob(suffix))
        self.text = {p: p.read_text() for p in self.files}

    def breach(self, path, line, what):
        here = path.relative_to(self.source) if path.is_absolute() else path
        self.breaches.append(f"{here}:{line}: {what}")

    def room(self, path):
        return path.relative_to(self.source / "src").parts[0]

    def name(self, path):
        """A header and its source are one: "store/claim"."""
        return path.relative_to(self.source / "src").with_suffix("").as_posix()

    # ---- what a file may include ---------------------------------------------------------------

    def check_law(self):
        allowed, libraries = {}, {}
        for _, name, value in read_list(self.lists / "include_law.txt"):
            (libraries if name.startswith("<") else allowed)[name] = set(value.split())
        for path in self.files:
            room = self.room(path)
            if room not in allowed:
                self.breach(path, 1, f"room '{room}' is not in the include law")
                continue
            for number, line in enumerate(self.text[path].splitlines(), 1):
                own = re.match(r'\s*#\s*include\s+"(\w+)/', line)
                if own and own.group(1) not in allowed[room] | {room, "core"}:
                    self.breach(path, number, f"{room} must not include {own.group(1)}")
                # Whoever asks the bridge itself cannot run on a scripted road.
                bridge = re.search(r"\bsumo_bridge(_\w+)?\b", line)
                if bridge and room != "traffic":
                    self.breach(path, number, f"{bridge.group()} is for traffic alone: ask cp_traffic_*")
                for header, rooms in libraries.items():
                    if re.match(r"\s*#\s*include\s+" + re.escape(header), line) and room not in rooms:
                        self.breach(path, number, f"{room} must not include {header}")
        for room in {p.name for p in (self.source / "src").iterdir() if p.is_dir()} - set(allowed):
            self.breach(self.source / "src" / room, 1, "room is not in the include law")

    def circles(self):
        """Files that include each other, round about or directly: sets of names (Tarjan)."""
        includes = {}
        for path in self.files:
            own = includes.setdefault(self.name(path), set())
            own |= set(re.findall(r'^\s*#\s*include\s+"([\w/]+)\.h"', self.text[path], re.M)) - {self.name(path)}
        order, low, stack, found = {}, {}, [], []

        def visit(name):
            order[name] = low[name] = len(order)
            stack.append(name)
            for other in sorted(includes.get(name, ())):
                if other not in order:
                    visit(other)
                    low[name] = min(low[name], low[other])
                elif other in stack:
                    low[name] = min(low[name], order[other])
            if low[name] == order[name]:
                circle = stack[stack.index(name):]
                del stack[stack.index(name):]
                if len(circle) > 1:
                    found.append(frozenset(circle))

        sys.setrecursionlimit(10000)
        for name in sorted(includes):
            if name not in order:
                visit(name)
        return found

    def check_circles(self):
        path = self.lists / "circles.txt"
        known = {frozenset(names.split()): number for number, names, reason in read_list(path) if reason}
        found = set(self.circles())
        for circle in found - set(known):
            self.breach(self.source / "src", 1, "files include each other in a circle: " + " ".join(sorted(circle)))
        for circle in set(known) - found:
            self.breach(path, known[circle], "is no circle any more: " + " ".join(sorted(circle)))

    # ---- what a file is ------------------------------------------------------------------------

    def check_files(self):
        for path in self.files:
            text = self.text[path]
            if "SPDX-License-Identifier: GPL-3.0-or-later" not in text.splitlines()[0]:
                self.breach(path, 1, "no SPDX licence line")
            if path.suffix == ".cpp" and path.name not in BRIDGES:
                self.breach(path, 1, "C++ outside the bridges")
            for number, line in enumerate(text.splitlines(), 1):
                # A definition at file scope that is neither const nor a function.
                state = re.match(r"^(static\s+)?(?!.*\b(const|typedef|extern|return)\b)"
                                 r"(unsigned |struct |volatile )*\w+[\s*]+\w+(\[[^\]]*\])*\s*(=.*)?;$", line)
                exempt = re.search(r"_Thread_local|sig_atomic_t", line)
                if state and path.suffix == ".c" and not exempt:
                    self.breach(path, number, "mutable state at file scope")

    def check_lengths(self):
        """Entries "file: reason", or "file <= lines: reason" for one beyond the end."""
        path = self.lists / "long_files.txt"
        listed = {}
        for number, name, reason in read_list(path):
            file, _, limit = name.partition("<=")
            listed[file.strip()] = (number, int(limit) if limit else LONGEST)
            if not reason:
                self.breach(path, number, f"{file.strip()} has no reason")
        scripts = sorted((self.source / "reports").rglob("*.js"))
        for file in self.files + scripts:
            here = file.relative_to(self.source).as_posix()
            lines = len(file.read_text().splitlines())
            number, limit = listed.pop(here, (0, LONG))
            if lines > limit:
                self.breach(file, lines, f"has {lines} lines, {limit} are the most"
                            + (" without a reason in long_files.txt" if limit == LONG else ""))
            elif number and (lines <= LONG or (limit > LONGEST and lines <= LONGEST)):
                self.breach(path, number, f"{here} needs no entry, or no limit, any more: {lines} lines")
        for here, (number, _) in listed.items():
            self.breach(path, number, f"there is no {here}")

    # ---- tests ---------------------------------------------------------------------------------

    def has_test(self, path):
        folder = self.source / "tests" / self.room(path)
        return any((folder / f"test_{path.stem}{ending}").exists() for ending in (".c", ".py"))

    def check_tests(self):
        """Entries "test: files of src", the test that runs what has none of its own name."""
        path = self.lists / "tested_by_others.txt"
        without = {p.relative_to(self.source / "src").as_posix() for p in self.files
                   if p.suffix != ".h" and not self.has_test(p)}
        listed = set()
        for number, test, files in read_list(path):
            if not (self.source / test).is_file():
                self.breach(path, number, f"there is no {test}")
            for file in files.split():
                if file not in without:
                    self.breach(path, number, f"{file} is not there, or has a test of its own")
                listed.add(file)
        for file in sorted(without - listed):
            self.breach(self.source / "src" / file, 1, f"has neither a test of its name nor stands in {path.name}")


def main():
    house = House(pathlib.Path(sys.argv[1]).resolve())
    for check in (house.check_law, house.check_circles, house.check_files, house.check_lengths, house.check_tests):
        check()
    print("\n".join(house.breaches) if house.breaches else f"{len(house.files)} files keep the rules of the house")
    return 1 if house.breaches or not house.files else 0


if __name__ == "__main__":
    sys.exit(main())
