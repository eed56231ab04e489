# SPDX-License-Identifier: GPL-3.0-or-later
"""The house's own rules: include law, licence lines, no file-scope mutable state, C++ only in
bridges, SUMO's bridge behind the traffic (cp_traffic_*). Prints every breach as file:line and ends with status 1 if there is one."""
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
allowed, libraries = {}, {}
for line in (source / "tests/house/include_law.txt").read_text().splitlines():
    line = line.strip()
    if not line or line.startswith("#"):
        continue
    name, rooms = line.split(":")
    (libraries if name.startswith("<") else allowed)[name] = set(rooms.split())

breaches, files = [], 0
for path in sorted(p for suffix in ("*.c", "*.h", "*.cpp") for p in (source / "src").rglob(suffix)):
    files += 1
    room = path.relative_to(source / "src").parts[0]
    here = path.relative_to(source)
    text = path.read_text()
    if "SPDX-License-Identifier: GPL-3.0-or-later" not in text.splitlines()[0]:
        breaches.append(f"{here}:1: no SPDX licence line")
    if room not in allowed:
        breaches.append(f"{here}:1: room '{room}' is not in the include law")
        continue
    if path.suffix == ".cpp" and path.name not in ("sumo_bridge.cpp", "sumo_roads.cpp", "optimiser.cpp"):
        breaches.append(f"{here}:1: C++ outside the two bridges")
    for number, line in enumerate(text.splitlines(), 1):
        own = re.match(r'\s*#\s*include\s+"(\w+)/', line)
        if own and own.group(1) not in allowed[room] | {room, "core"}:
            breaches.append(f"{here}:{number}: {room} must not include {own.group(1)}")
        # Whoever asks the bridge itself cannot run on a scripted road.
        bridge = re.search(r"\bsumo_bridge(_\w+)?\b", line)
        if bridge and room != "traffic":
            breaches.append(f"{here}:{number}: {bridge.group()} is for traffic alone: ask cp_traffic_*")
        for header, rooms in libraries.items():
            if re.match(r"\s*#\s*include\s+" + re.escape(header), line) and room not in rooms:
                breaches.append(f"{here}:{number}: {room} must not include {header}")
        # A definition at file scope that is neither const nor a function.
        state = re.match(r"^(static\s+)?(?!.*\b(const|typedef|extern|return)\b)"
                         r"(unsigned |struct |volatile )*\w+[\s*]+\w+(\[[^\]]*\])*\s*(=.*)?;$", line)
        exempt = re.search(r"_Thread_local|sig_atomic_t", line)
        if state and path.suffix == ".c" and not exempt:
            breaches.append(f"{here}:{number}: mutable state at file scope")
for room in {p.name for p in (source / "src").iterdir() if p.is_dir()} - set(allowed):
    breaches.append(f"src/{room}: room is not in the include law")
print("\n".join(breaches) if breaches else f"{files} files keep the rules of the house")
sys.exit(1 if breaches or files == 0 else 0)
