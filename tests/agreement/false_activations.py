#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""false_activations.py CRASHPULSE [--output FILE] [--seconds S] [NETWORK ...]: how often functions act
for nothing. On every network everybody drives as SUMO has it, without any driver error; every car has
the function. A function that only warns leaves the traffic as it is, so that what comes after each
warning can be looked at: it was for nothing unless the two bodies touch, or one of the two drivers brakes
harder than at ease (4.5 m/s2), within the TTC and 2 s more (src/control/fcw.c). AEB is measured like that
too: as a warning by AEB's numbers that nobody heeds. With --bar, exit status 1 when anything is for
nothing."""
import argparse
import json
import math
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("crashpulse")
parser.add_argument("networks", nargs="*")
parser.add_argument("--output")
parser.add_argument("--seconds", type=int, default=400)
parser.add_argument("--bar", action="store_true")
arguments = parser.parse_intermixed_args()
crashpulse = pathlib.Path(arguments.crashpulse).resolve()
source = pathlib.Path(__file__).resolve().parents[2]
shared = source.parent / "shared"
environment = {**os.environ, "SUMO_HOME": "/usr/share/sumo"}

# Numbers of aeb by default (src/control/aeb.c) for a warning: crossing and turning targets too.
AEB = ("ttc_s: 1.2, required_deceleration_m_s2: {required}, speed_min_m_s: 2.78, sensor_range_m: 80, "
       "sensor_field_of_view_deg: 60, crossing_1: 1, turning_1: 1, release_ttc_s: 3, compliance_1: 0")
WIDE = ("ttc_s: 1.3, required_deceleration_m_s2: 4.5, speed_min_m_s: 2.78, sensor_range_m: 100, "
        "sensor_field_of_view_deg: 100, crossing_1: 1, turning_1: 1, release_ttc_s: 3, compliance_1: 0")
WARNINGS = {"AEB": AEB.format(required=4.5), "AEB from 3 m/s2": AEB.format(required=3), "AEB, wide": WIDE,
            "FCW": "compliance_1: 0", "FCW, all classes": "compliance_1: 0, crossing_1: 1, turning_1: 1"}
VARIANTS = "variants:\n" + "".join(
    f"  - {{name: w{k}, functions: [{{function: fcw, parameters: {{{numbers}}}}}]}}\n"
    for k, numbers in enumerate(WARNINGS.values())) + "  - {name: acting, functions: [{function: aeb}]}\n"


def netconvert(folder, nodes, edges, *options):
    (folder / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (folder / "n.edg.xml").write_text(f"<edges>{edges}</edges>")
    subprocess.run(["netconvert", "-n", "n.nod.xml", "-e", "n.edg.xml", "-o", "n.net.xml",
                    "--no-turnarounds", "true", "--xml-validation", "never", *options], cwd=folder,
                   check=True, capture_output=True, env=environment)


def node(name, x, y, more=""):
    return f'<node id="{name}" x="{x:.3f}" y="{y:.3f}" {more}/>'


def edge(name, start, end, speed, lanes=1, points=(), more=""):
    shape = f' shape="{" ".join(",".join(f"{v:.3f}" for v in p) for p in points)}"' if points else ""
    return (f'<edge id="{name}" from="{start}" to="{end}" speed="{speed:.2f}" numLanes="{lanes}"'
            f'{shape} {more}/>')


def flows(folder, *lines, types='<vType id="car" speedFactor="normc(1,0.1,0.8,1.2)"/>'):
    (folder / "n.rou.xml").write_text(f"<routes>{types}{''.join(lines)}</routes>")
    (folder / "n.sumocfg").write_text('<configuration><input><net-file value="n.net.xml"/>'
                                      '<route-files value="n.rou.xml"/></input></configuration>')
    return folder / "n.sumocfg"


def flow(name, start, end, period, more=""):
    return (f'<flow id="{name}" type="car" from="{start}" to="{end}" begin="0" end="9000" '
            f'period="{period}" departSpeed="max" departLane="best" {more}/>')


def bend(folder, radius, piece_deg, turn_deg=90.0):
    """Two directions round one bend of straight pieces, driven at 3 m/s2 of lateral acceleration."""
    speed, leg = min(math.sqrt(3.0 * radius), 36.0), 200.0
    count = max(1, round(turn_deg / piece_deg))
    arc = [(radius * math.sin(math.radians(turn_deg * k / count)),
            radius - radius * math.cos(math.radians(turn_deg * k / count))) for k in range(count + 1)]
    end = math.radians(turn_deg)
    last = (arc[-1][0] + leg * math.cos(end), arc[-1][1] + leg * math.sin(end))
    points = [(-leg, 0.0), *arc, last]
    netconvert(folder, node("w", *points[0]) + node("n", *last),
               edge("wn", "w", "n", speed, points=points) +
               edge("nw", "n", "w", speed, points=points[::-1]), "--geometry.max-angle", "170")
    return flows(folder, flow("a", "wn", "wn", 2.9), flow("b", "nw", "nw", 3.1))


def bridge(folder, height):
    """One road over another, with heights or without."""
    z = f'z="{height}"' if height else ""
    netconvert(folder, node("w", -300, 0) + node("e", 300, 0) + node("s", 0, -300, z) +
               node("n", 0, 300, z),
               "".join(edge(a + b, a, b, 25) for a, b in ("we", "ew", "sn", "ns")))
    return flows(folder, *(flow(a + b, a + b, a + b, 3 + k / 10)
                           for k, (a, b) in enumerate(("we", "ew", "sn", "ns"))))


def roundabout(folder):
    radius, nodes, edges = 18.0, "", ""
    names = ["e", "n", "w", "s"]
    for k, name in enumerate(names):
        angle = math.pi / 2 * k
        nodes += node(name, 220 * math.cos(angle), 220 * math.sin(angle))
        nodes += node("r" + name, radius * math.cos(angle), radius * math.sin(angle))
        edges += edge(f"in_{name}", name, "r" + name, 13.9) + edge(f"out_{name}", "r" + name, name, 13.9)
    for k in range(4):
        arc = [(radius * math.cos(math.pi / 2 * (k + s / 8)), radius * math.sin(math.pi / 2 * (k + s / 8)))
               for s in range(9)]
        edges += edge(f"c{k}", "r" + names[k], "r" + names[(k + 1) % 4], 8.3, points=arc,
                      more='priority="10"')
    netconvert(folder, nodes, edges, "--roundabouts.guess", "true")
    return flows(folder, *(flow(f"{a}{b}", f"in_{a}", f"out_{b}", 17 + k)
                           for k, (a, b) in enumerate((a, b) for a in names for b in names if a != b)))


def merge(folder):
    """A motorway of two lanes with an on-ramp and an acceleration lane."""
    netconvert(folder, node("a", 0, 0) + node("m", 700, 0) + node("r", 450, -120) + node("z", 1500, 0),
               edge("main", "a", "m", 33, 2) + edge("ramp", "r", "m", 22) + edge("on", "m", "z", 33, 2),
               "--ramps.guess", "true")
    return flows(folder, flow("main", "main", "on", 1.6), flow("ramp", "ramp", "on", 5))


def lanes(folder, resolution):
    """Three lanes, fast and slow: changes of lanes all the time; with the sublane model too."""
    netconvert(folder, node("a", 0, 0) + node("z", 3000, 0), edge("az", "a", "z", 33, 3))
    types = ('<vType id="car" speedFactor="normc(1,0.2,0.6,1.3)"/>'
             '<vType id="truck" vClass="truck" maxSpeed="22"/>')
    path = flows(folder, flow("a", "az", "az", 1.1).replace("best", "random"),
                 flow("t", "az", "az", 6).replace('"car"', '"truck"').replace("best", "random"),
                 types=types)
    if resolution:
        path.write_text(path.read_text().replace(
            "</input>", f'</input><lateral-resolution value="{resolution}"/>'))
    return path


def town(folder):
    """A signalised town of curved streets, turns from shared lanes, right turns on red."""
    subprocess.run(["netgenerate", "--rand", "--rand.iterations", "60", "--seed", "7", "--rand.min-distance",
                    "120", "--rand.max-distance", "260", "--tls.guess", "true", "--default.lanenumber",
                    "2", "--turn-lanes", "1", "--random-lanenumber", "true", "-o", "n.net.xml"],
                   cwd=folder, check=True, capture_output=True, env=environment)
    subprocess.run([sys.executable, "/usr/share/sumo/tools/randomTrips.py", "-n", "n.net.xml", "-o",
                    "trips.xml", "-r", "n.rou.xml", "-e", "900", "-p", "0.7", "--seed", "3",
                    "--fringe-factor", "5"], cwd=folder, check=True, capture_output=True, env=environment)
    (folder / "n.sumocfg").write_text('<configuration><input><net-file value="n.net.xml"/>'
                                      '<route-files value="n.rou.xml"/></input></configuration>')
    return folder / "n.sumocfg"


def bologna(folder):
    """A copy: its outputs stay with it."""
    source = shared / "reference/sumo_bologna_acosta"
    if source.exists():
        for path in source.glob("*"):
            shutil.copyfile(path, folder / path.name)
    return folder / "run.sumocfg"


NETWORKS = {f"bend R {radius} m, pieces of {piece} deg": lambda f, r=radius, p=piece: bend(f, r, p)
            for radius in (30, 80, 300, 1000) for piece in (1, 5, 15)}
NETWORKS |= {"bridge with heights": lambda f: bridge(f, 7), "bridge without heights": lambda f: bridge(f, 0),
             "roundabout": roundabout, "motorway merge": merge, "three lanes": lambda f: lanes(f, 0),
             "three lanes, sublane model": lambda f: lanes(f, 0.8), "signalised town": town,
             "Bologna": bologna}


def study(folder, configuration, seconds):
    path = folder / "study.yaml"
    path.write_text(f"study: none\ndesign: paired_seeds\nseed: 1\nreplications: 1\nduration_s: {seconds}\n"
                    f"step_length_s: 0.1\nbackground: {{duration_s: 0}}\nscenarios:\n"
                    f"  - {{name: network, sumocfg: {configuration}}}\n{VARIANTS}")
    return path


def measure(name):
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        configuration = NETWORKS[name](folder)
        if not configuration.exists():
            return None
        seconds = 900 if name == "Bologna" else arguments.seconds
        db = folder / "f.db"
        result = subprocess.run([crashpulse, "run", study(folder, configuration, seconds), "--db", db],
                                capture_output=True, text=True)
        if result.returncode != 0:
            sys.exit(f"{name}: {result.stderr}")
        rows = sqlite3.connect(db).execute(
            "SELECT variant.name, vehicle_h, counters, (SELECT count(*) FROM crash WHERE replication_id = "
            "replication.id) FROM replication JOIN variant ON variant.id = variant_id").fetchall()
    found = {variant: (hours, json.loads(counters or "{}"), crashes)
             for variant, hours, counters, crashes in rows}
    row = {"vehicle_h": found["w0"][0], "crashes": found["w0"][2],
           "acting": found["acting"][1].get("aeb.activations", 0.0)}
    for k, name in enumerate(WARNINGS):
        counters = found[f"w{k}"][1]
        warnings = counters.get("fcw.warnings", 0.0)
        row[name] = warnings - counters.get("fcw.warnings_borne_out", 0.0), warnings
    return row


lines = ["| network | vehicle-h | crashes | " + " | ".join(WARNINGS) + " | AEB acts |",
         "|---|---:|---:|" + "---:|" * (len(WARNINGS) + 1)]
missed = []
for name in arguments.networks or NETWORKS:
    row = measure(name)
    if row is None:
        print(f"SKIPPED: {name} is not there")
        continue
    cells = [f"{1000 * nothing / row['vehicle_h']:.0f} ({nothing:.0f} of {all_of_them:.0f})"
             for nothing, all_of_them in (row[warning] for warning in WARNINGS)]
    lines.append(f"| {name} | {row['vehicle_h']:.1f} | {row['crashes']} | " + " | ".join(cells) +
                 f" | {row['acting']:.0f} |")
    print(lines[-1], flush=True)
    if any(row[warning][0] > 0 for warning in WARNINGS):
        missed.append(name)
text = "\n".join(lines) + "\n"
if arguments.output:
    pathlib.Path(arguments.output).write_text(
        "# Activations for nothing\n\nMade by `cmake --build build --target false_activations`. Nobody errs, "
        "every car has the function. Per 1000\nvehicle-hours, and in brackets in number: activations or "
        "warnings for nothing, of all. For nothing is what is\nfollowed, in the same traffic without the "
        "function, neither by a touch of the two bodies nor by a braking of one of\nthe two drivers harder "
        "than at ease (4.5 m/s²), within the TTC and 2 s more. AEB is looked at as a warning by its\nnumbers "
        "that nobody heeds; \"AEB from 3 m/s²\" acts where braking at ease would do. The last column is how "
        "often AEB\nbrakes when it does act.\n\n" + text)
if arguments.bar and missed:
    sys.exit(f"functions act for nothing: {', '.join(missed)}")
