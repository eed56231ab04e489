# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped matrices of sumo_scenarios/ncap on SUMO: impact speeds with AEB against the exact motion
(exact.py) in every cell, without it the speed that was asked for; the same bits however many workers and for
AEB as a library; the table in all formats, the map, and what is refused."""
import argparse
import csv
import io
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "builders"))
import crossing_study
import exact

parser = argparse.ArgumentParser()
parser.add_argument("--crashpulse", required=True)
parser.add_argument("--source", required=True)
parser.add_argument("--libraries", required=True)
parser.add_argument("--few", action="store_true", help="two of the matrices: with sanitizers all take minutes")
arguments = parser.parse_args()
arguments.crashpulse = str(pathlib.Path(arguments.crashpulse).resolve())
NCAP = pathlib.Path(arguments.source) / "sumo_scenarios/ncap"
FILES = sorted(NCAP.glob("*.yaml"))[:2 if arguments.few else None]
TOLERANCE_M_S = 0.3
STANDARD = {"own_km_h": 50, "target_km_h": 0, "offset_1": 0, "impact_1": 0.5, "from_left_1": 0, "radius_m": 10,
            "lane_m": 3.5, "headway_m": 12, "target_deceleration_m_s2": 6}


def matrix(path, db, *words, expect=0):
    return crossing_study.run(arguments.crashpulse, "matrix", path, "--db", db, *words, expect=expect)


def described(path):
    """Encounter, fixed parameters and AEB's of a matrix file, read by its few forms of lines."""
    text = path.read_text()
    fixed = {name: float(value) for name, value in
             re.findall(r"- \{parameter: (\w+), value: ([-\d.]+)\}", text)}
    given = dict(re.findall(r"(\w+): ([-\d.]+)", re.search(r"function: aeb, parameters: \{(.*)\}\}", text)[1]))

    def of(name, standard):
        return float(given.pop(name, standard))
    aeb = {"ttc": of("ttc_s", 1.2), "required": of("required_deceleration_m_s2", 4.5),
           "deceleration": min(of("deceleration_m_s2", 8.0), 0.9 * 9.80665), "jerk": of("jerk_m_s3", 40.0),
           "delay": of("dead_time_s", 0.1) + of("sensor_latency_s", 0.1),
           "confirmation": of("sensor_confirmation_s", 0.2), "range": of("sensor_range_m", 80.0),
           "view": math.radians(of("sensor_field_of_view_deg", 60.0))}
    speed_min = of("speed_min_m_s", 2.78)
    assert not given, f"{path}: {given} is not known here"
    return re.search(r"encounter: (\w+)", text)[1], fixed, aeb, speed_min


def against_the_exact_motion(folder):
    seconds, cells, worst = 0.0, 0, 0.0
    for path in FILES:
        encounter, fixed, aeb, speed_min = described(path)
        began = time.monotonic()
        table = json.loads(matrix(path, folder / f"{path.stem}.db", "--format", "json", "--jobs", "2").stdout)
        seconds += time.monotonic() - began
        largest = 0.0
        for row in table:
            p = {**STANDARD, **fixed, **{k: v for k, v in row.items() if k in STANDARD}}
            if encounter == "braking":
                p["target_km_h"] = p["own_km_h"]
            assert p["own_km_h"] / 3.6 > speed_min
            never = {**aeb, "ttc": 0.0}
            free = exact.impact_m_s(encounter, p, never)
            if encounter != "braking":
                assert free is not None and abs(row["without_impact_km_h"] / 3.6 - free) < 0.05, (path, row, free)
            wanted = exact.impact_m_s(encounter, p, aeb)
            if row["outcome"] == "graze":  # a corner on a side, by less than counts as a crash
                assert wanted is not None and wanted < 3.0, (path.name, row, wanted)
                continue
            found = row["impact_km_h"] / 3.6 if row["outcome"] == "impact" else None
            off = abs((wanted or 0.0) - (found or 0.0))
            assert off < TOLERANCE_M_S, (path.name, row, wanted)
            largest = max(largest, off)
            if found is not None:
                assert row["contact_on"] == "front" and row["delta_v_km_h"] > 0, row
        outcomes = [row["outcome"] for row in table]
        assert encounter in ("crossing", "turning") or "graze" not in outcomes, outcomes
        assert "impact" in outcomes and "no encounter" not in outcomes, path
        print(f"{path.stem}: {len(table)} cells, {outcomes.count('avoided')} avoided, "
              f"{outcomes.count('graze')} grazed, within {largest:.3f} m/s")
        cells, worst = cells + len(table), max(worst, largest)
    print(f"{cells} cells in {seconds:.1f} s, within {worst:.3f} m/s")


def same_bits(folder):
    """However many workers; and for AEB built as a library."""
    path = NCAP / "ccftap.yaml"
    one = matrix(path, folder / "one.db", "--jobs", "1", "--format", "json").stdout
    assert one == matrix(path, folder / "two.db", "--jobs", "2", "--format", "json").stdout
    assert one == matrix(path, folder / "two.db", "--format", "json").stdout, "asked again"
    own = matrix(path, folder / "own.db", "--function", "aeb", "--format", "json").stdout
    library = pathlib.Path(arguments.libraries) / "aeb.so"
    assert own == matrix(path, folder / "library.db", "--library", library, "--format", "json").stdout
    assert own != one, "the file's parameters did nothing"


def formats_and_map(folder):
    path, db, figure = NCAP / "ccfhos.yaml", folder / "formats.db", folder / "map.svg"
    table = matrix(path, db, "--plot", figure).stdout
    assert "impact_km_h" in table and "assumed" in table, table
    rows = list(csv.DictReader(io.StringIO(matrix(path, db, "--format", "csv").stdout)))
    assert len(rows) == 27 and float(rows[0]["impact_km_h"]) > 0, rows[0]
    svg = figure.read_text()
    for row in rows:
        shown = "avoided" if row["outcome"] == "avoided" else f"{float(row['impact_km_h']):.1f}"
        assert shown in svg, shown
    assert "own_km_h" in svg and svg.count("offset_1") == 3, "three panels"


def refused(folder):
    text = (NCAP / "ccrs.yaml").read_text()
    bad = folder / "bad.yaml"
    for old, new, wanted in (("rear_end", "sideways", "must be rear_end, braking, head_on, crossing or turning"),
                             ("own_km_h", "own_speed", "must be one of own_km_h, target_km_h"),
                             ("values: [10,", "values: [1000,", "1000"),
                             ("function: aeb", "function: aebs", "must be one of aeb"),
                             ("matrix: ccrs", "matrix: c c", "must be 1 to 64 letters")):
        assert old in text
        bad.write_text(text.replace(old, new))
        result = matrix(bad, folder / "bad.db", expect=2)
        assert wanted in result.stderr and "bad.yaml:" in result.stderr, result.stderr
    assert "either" in matrix(NCAP / "ccrs.yaml", folder / "bad.db", "--function", "aeb", "--library", "x.so",
                              expect=2).stderr
    assert "no function 'plugin'" in matrix(NCAP / "ccrs.yaml", folder / "bad.db", "--function", "plugin",
                                            expect=2).stderr
    assert not (folder / "bad.db").exists()
    # A faulty function is named.
    broken = pathlib.Path(arguments.libraries) / "faulty_segfault.so"
    result = matrix(NCAP / "ccrs.yaml", folder / "broken.db", "--library", broken, expect=1)
    assert "faulty_segfault" in result.stderr and "crashed" in result.stderr, result.stderr


with tempfile.TemporaryDirectory(prefix="crashpulse-test-") as name:
    for test in (refused, formats_and_map, same_bits, against_the_exact_motion):
        test(pathlib.Path(name))
        print(f"{test.__name__}: ok", flush=True)
