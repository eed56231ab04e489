#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""agreement.py BUILD SOURCE [--output TABLE.md] [NETWORK ...]: SUMO's own collision reports against our
contacts, and what crashes were found.

Runs every network named (default: all) at step lengths 0.1 and 0.05 s through 'crashpulse run' and
holds SUMO's collisions against what the database says of the same pair:
  matched      a crash of ours in the same step, or one step earlier or later
  explained    a contact of ours that is no crash, with its reason
  apart        the rectangles never touched: SUMO reports a pair whose gap is small but not nothing;
               the gap is listed
  unexplained  neither: the rectangles did overlap and we have no contact
Our crashes that SUMO lacks are counted by where they are, which is why SUMO has none: it looks at cars
of one lane and at foes inside a junction, neither at cars on the lanes of opposite directions or of
two edges beside a junction (road) nor at those inside a junction without right-of-way rules
(unregulated junction), and misses corners inside the others. Exit status 1 when a collision of SUMO
is unexplained, a match is off in time, a crash has a delta-v below 1 km/h, or there are fewer reports than
AGREEMENT_LEAST. AGREEMENT_STEPS and AGREEMENT_SECONDS: other step lengths and a shorter run."""
import argparse
import collections
import gzip
import math
import os
import pathlib
import shutil
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import signalised_town

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("build", type=pathlib.Path)
parser.add_argument("source", type=pathlib.Path)
parser.add_argument("network", nargs="*", help="default: all")
parser.add_argument("--output", type=pathlib.Path, help="a table in Markdown")
arguments = parser.parse_intermixed_args()
build, source = arguments.build.resolve(), arguments.source.resolve()
seconds = float(os.environ.get("AGREEMENT_SECONDS", "0"))
least = int(os.environ.get("AGREEMENT_LEAST", "0"))  # reports of SUMO that each run must have
settings = "".join(f"{name}='{os.environ[name]}' " for name in ("AGREEMENT_SECONDS", "AGREEMENT_STEPS")
                   if name in os.environ)
steps = [float(s) for s in os.environ.get("AGREEMENT_STEPS", "0.1 0.05").split()]
scenarios = build / "sumo_scenarios"
games = pathlib.Path("/usr/share/sumo/tools/game")
bologna = source.parent / "shared/reference/sumo_bologna_acosta"

# name: (configuration, driver errors, simulated seconds)
NETWORKS = {
    "left_turn": (scenarios / "left_turn/left_turn.sumocfg",
                  [("failed_to_see", "probability_1: 0.3")], 1800),
    "crossing": (scenarios / "crossing/crossing.sumocfg",
                 [("failed_to_see", "probability_1: 0.1"), ("misjudged_gap", "probability_1: 0.1"),
                  ("red_light", "probability_1: 0.05")], 1800),
    "head_on_overtaking": (scenarios / "head_on_overtaking/head_on_overtaking.sumocfg",
                           [("risky_overtaking", "probability_1: 0.5")], 1800),
    "bologna": (bologna / "run.sumocfg", [], 900),
    "bologna_errors": (bologna / "run.sumocfg",
                       [("failed_to_see", "probability_1: 0.1"),
                        ("misjudged_gap", "probability_1: 0.1")], 900),
    "game_cross": (games / "cross.sumocfg", [], 600),
    "game_square": (games / "square.sumocfg", [], 600),
    "game_ramp": (games / "ramp.sumocfg", [], 600),
    "game_grid6": (games / "grid6.sumocfg", [], 300),
    # A road with oncoming traffic that drifts, for the length of steps.
    "head_on_drift": (scenarios / "head_on_drift/head_on_drift.sumocfg",
                      [("lane_drift", "rate_per_h: 20, left_1: 0.5")], 1800),
}
# Towns made here (signalised_town.py): how, and what drivers do wrong.
TOWN_ERRORS = [("failed_to_see", "probability_1: 0.05"), ("late_braking", "rate_per_h: 20"),
               ("lane_drift", "rate_per_h: 20")]
TOWNS = {
    "signalised_town": ({}, []),
    "signalised_town_errors": ({}, TOWN_ERRORS),
    "signalised_town_sublane": ({"sublane": True}, TOWN_ERRORS),
    "signalised_town_lefthand": ({"lefthand": True}, TOWN_ERRORS),
}


def make_towns(folder, names):
    """Their configurations, among the others."""
    for name in names:
        if name in TOWNS:
            options, errors = TOWNS[name]
            NETWORKS[name] = (signalised_town.make(folder / "towns" / name, **options), errors, 900)


def creeping(database):
    """Confirmed crashes whose cars hardly change their velocity: below 1 km/h, or simulated without contact."""
    return [f"    {a} {b}: crash at {time_s:.2f} s with a delta-v of {delta_v_m_s * 3.6:.2f} km/h"
            for time_s, a, b, delta_v_m_s in sqlite3.connect(database).execute(
                "SELECT c.time_s, a.sumo_id, b.sumo_id, max(coalesce(a.delta_v_m_s, 0), coalesce(b.delta_v_m_s, "
                "0)) AS most_m_s FROM crash AS c JOIN crash_vehicle AS a ON a.crash_id = c.id AND a.role = "
                "'a' JOIN crash_vehicle AS b ON b.crash_id = c.id AND b.role = 'b' WHERE c.validity NOT LIKE "
                "'%no_model%' AND a.validity NOT LIKE '%no_model%' AND b.validity NOT LIKE '%no_model%' GROUP "
                "BY c.id HAVING most_m_s < 1 / 3.6")]


def run(folder, name, step):
    """Database of one network at one step length; None when the network is not there."""
    configuration, errors, duration = NETWORKS[name]
    if not configuration.exists():
        return None
    # A copy: outputs that a configuration names are written beside it.
    copy = folder / configuration.parent.name
    if not copy.exists():
        shutil.copytree(configuration.parent, copy)
    models = "\n".join(f"      - model: {model}\n        parameters: {{{parameters}}}"
                       for model, parameters in errors)
    study = folder / f"{name}_{step}.yaml"
    study.write_text(
        f"study: {name}\ndesign: independent\nseed: 7\nreplications: 1\n"
        f"duration_s: {seconds or duration}\nstep_length_s: {step}\nbackground: {{duration_s: 0}}\n"
        f"scenarios:\n"
        f"  - name: {name}\n    sumocfg: {copy / configuration.name}\n"
        + (f"    driver_errors:\n{models}\n" if errors else "")
        + f"variants:\n  - name: baseline\nvehicles:\n"
        f"  default: {source / 'db/vehicles/mid_size.yaml'}\n")
    database = folder / f"{name}_{step}.db"
    subprocess.run([build / "crashpulse", "run", study, "--db", database, "--jobs", "1"],
                   check=True, stderr=subprocess.PIPE)
    return database


def junctions(configuration):
    """Outlines of the junctions of a configuration's network, with their types and names."""
    network = xml.etree.ElementTree.parse(configuration).find(".//net-file").get("value")
    path = configuration.parent / network
    with (gzip.open if path.suffix == ".gz" else open)(path, "rb") as file:
        return [(junction.get("type"), junction.get("id"), [tuple(map(float, point.split(",")[:2]))
                                                            for point in junction.get("shape").split()])
                for junction in xml.etree.ElementTree.parse(file).getroot().iter("junction")
                if junction.get("type") != "internal" and junction.get("shape")]


def distance_m(point, outline):
    """From a point to an outline; 0 inside."""
    x, y = point
    inside, nearest = False, math.inf
    for (ax, ay), (bx, by) in zip(outline, outline[1:] + outline[:1]):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            inside = not inside
        length = (bx - ax) ** 2 + (by - ay) ** 2
        along = max(0.0, min(1.0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / (length or 1.0)))
        nearest = min(nearest, math.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay)))
    return 0.0 if inside else nearest


def place_of(point, outlines):
    """Where a crash is: in or within a car's width of a junction, by its type, or on a road."""
    kind, _, gap_m = nearest_junction(point, outlines)
    return f"{kind} junction" if gap_m < 2.0 else "road"


def nearest_junction(point, outlines):
    return min(((kind, name, distance_m(point, outline)) for kind, name, outline in outlines),
               key=lambda found: found[2])


def crash_types(database, outlines):
    """Rows of our crashes by type and place: closing speeds least, median, most."""
    speeds = collections.defaultdict(list)
    for kind, x_m, y_m, speed_m_s in sqlite3.connect(database).execute(
            "SELECT crash_type, x_m, y_m, closing_speed_m_s FROM crash"):
        speeds[kind, place_of((x_m, y_m), outlines)].append(speed_m_s)
    return [(kind, place, len(found), min(found), statistics.median(found), max(found))
            for (kind, place), found in sorted(speeds.items())]


def each_crash(database, outlines):
    """Rows of our crashes one by one: who, how, where, and what of the other lay in a's way."""
    rows = []
    for time_s, kind, speed_m_s, angle_rad, overlap, x_m, y_m, a, a_m_s, a_side, b, b_m_s, b_side in \
            sqlite3.connect(database).execute(
                "SELECT c.time_s, c.crash_type, c.closing_speed_m_s, c.angle_rad, c.overlap_1, c.x_m, c.y_m, "
                "a.sumo_type || ' ' || a.sumo_id, a.speed_m_s, a.contact_side, b.sumo_type || ' ' || "
                "b.sumo_id, b.speed_m_s, b.contact_side FROM crash c JOIN crash_vehicle a ON a.crash_id = "
                "c.id AND a.role = 'a' JOIN crash_vehicle b ON b.crash_id = c.id AND b.role = 'b' ORDER BY "
                "c.time_s"):
        junction, name, gap_m = nearest_junction((x_m, y_m), outlines)
        place = f"{junction} junction {name}" if gap_m < 2.0 else f"road, {gap_m:.0f} m from junction {name}"
        rows.append((f"{time_s:.2f}", kind, f"{speed_m_s:.1f}", f"{math.degrees(angle_rad):.0f}",
                     "" if overlap is None else f"{overlap:.2f}", f"{a}, {a_side}, {a_m_s:.1f} m/s",
                     f"{b}, {b_side}, {b_m_s:.1f} m/s", place))
    return rows


def compare(database, step, outlines):
    """Counts of one database and the lines about what does not agree."""
    db = sqlite3.connect(database)
    crashes = {}
    for time_s, kind, x_m, y_m, one, other in db.execute(
            "SELECT c.time_s, c.crash_type, c.x_m, c.y_m, a.sumo_id, b.sumo_id FROM crash c "
            "JOIN crash_vehicle a ON a.crash_id = c.id AND a.role = 'a' "
            "JOIN crash_vehicle b ON b.crash_id = c.id AND b.role = 'b'"):
        crashes[frozenset((one, other))] = (time_s, kind, (x_m, y_m))
    counts, reasons, bad, apart, reported = collections.Counter(), collections.Counter(), [], [], set()
    for time_s, one, other, kind, found_as, gap_m in db.execute(
            "SELECT time_s, collider, victim, sumo_type, found_as, gap_m FROM sumo_collision"):
        pair = frozenset((one, other))
        reported.add(pair)
        counts["sumo"] += 1
        if pair in crashes:
            counts["matched"] += 1
            # SUMO's time is the end of a step; ours lies inside one, the end of which counts.
            late = round(math.ceil(crashes[pair][0] / step - 1e-6) - time_s / step)
            if abs(late) > 1:
                counts["off in time"] += 1
                bad.append(f"    {one} {other}: SUMO {time_s:.2f} s ({kind}), ours {late:+d} steps")
        elif found_as == "no_contact" and gap_m is not None and gap_m > 0:
            counts["apart"] += 1
            apart.append(f"    {one} {other}: SUMO {time_s:.2f} s ({kind}), rectangles {gap_m:.3f} m apart")
        elif found_as == "no_contact":
            counts["unexplained"] += 1
            bad.append(f"    {one} {other}: SUMO {time_s:.2f} s ({kind}), no contact of ours")
        else:
            counts["explained"] += 1
            reasons[found_as] += 1
    ours = collections.Counter(f"{kind} at {place_of(point, outlines)}"
                               for pair, (_, kind, point) in crashes.items() if pair not in reported)
    counts["ours"] = len(crashes)
    counts["ours only"] = sum(ours.values())
    for reason, number in db.execute("SELECT verdict, count(*) FROM contact GROUP BY 1"):
        reasons[f"contact {reason}"] = number
    return counts, reasons, ours, bad, apart


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


names = arguments.network or list(NETWORKS) + list(TOWNS)
columns = ["sumo", "matched", "off in time", "explained", "apart", "unexplained", "ours", "ours only",
           "per 1000 veh-h", "below 1 km/h"]
print(f"{'network':20} {'step s':>6} " + " ".join(f"{c:>11}" for c in columns))
agrees = True
table, types, singles = [], [], []
with tempfile.TemporaryDirectory() as folder:
    make_towns(pathlib.Path(folder), names)
    for name in names:
        for step in steps:
            database = run(pathlib.Path(folder), name, step)
            if database is None:
                print(f"{name:20} is not here: skipped")
                break
            outlines = junctions(NETWORKS[name][0])
            counts, reasons, ours, bad, apart = compare(database, step, outlines)
            slow = creeping(database)
            hours, = sqlite3.connect(database).execute("SELECT vehicle_h FROM replication").fetchone()
            counts["below 1 km/h"] = len(slow)
            counts["per 1000 veh-h"] = round(1000 * counts["ours"] / hours) if hours else 0
            bad += slow
            print(f"{name:20} {step:6g} " + " ".join(f"{counts[c]:11d}" for c in columns))
            for label, counter in (("reasons", reasons), ("ours only", ours)):
                if counter:
                    print(f"    {label}: " + ", ".join(f"{k} {v}" for k, v in sorted(counter.items())))
            print("\n".join(apart + bad), end="\n" if apart or bad else "")
            for row in crash_types(database, outlines):
                print("    found: {} at {}: {}, closing speed {:.1f} to {:.1f}, median {:.1f} m/s".format(
                    row[0], row[1], row[2], row[3], row[5], row[4]))
                types.append((name, f"{step:g}", *row[:3], *(f"{speed:.1f}" for speed in row[3:])))
            if not NETWORKS[name][1]:
                for row in each_crash(database, outlines):
                    print("    without driver errors: {} s {}, {} m/s, {} degrees, overlap {}: {}; {}; {}".format(
                        *row))
                    singles.append((name, f"{step:g}", *row))
            sys.stdout.flush()
            table.append((name, f"{step:g}", *(counts[c] for c in columns),
                          ", ".join(f"{k} {v}" for k, v in sorted(reasons.items()))))
            agrees &= not bad and counts["sumo"] >= least
if arguments.output:
    arguments.output.write_text("\n\n".join((
        "# SUMO's collisions against ours, and what was found",
        f"Made by `{settings}tests/agreement/agreement.py build . --output FILE{''.join(' ' + n for n in arguments.network)}`, "
        "whose head says what the columns mean (`cmake --build build --target agreement` runs every network).",
        markdown(["network", "step s", *columns, "reasons"], table),
        "## Crashes by type and place",
        "Closing speeds in m/s.",
        markdown(["network", "step s", "type", "at", "crashes", "least", "median", "most"], types),
        "## Every crash without driver errors",
        markdown(["network", "step s", "time s", "type", "closing m/s", "angle", "overlap", "a", "b", "at"],
                 singles) if singles else "None.")) + "\n")
sys.exit(0 if agrees else 1)
