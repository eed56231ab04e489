#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make evidence.csv: which classes of crashes the tests speak for, a vehicle, and with which error.

    cmake --build build --target evidence
    python3 db/validation/evidence.py build/crashpulse [--output FOLDER]

From scorecard.csv (bars kept and errors), boxes.csv (what the classes stand around) and, where no test
stands at a speed and an overlap both, simulations by the parameter sets of each vehicle's ensemble. The
program carries the table: validity of every crash comes from it (README.md, "From the scorecard to
validity")."""
import argparse
import csv
import hashlib
import io
import json
import math
import pathlib
import re
import statistics
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
VEHICLES = HERE.parent / "vehicles"
COLUMNS = ("class", "vehicle", "vehicle_sha256", "opponent", "speed_min_km_h", "speed_max_km_h", "overlap_min_1",
           "overlap_max_1", "angle_max_deg", "velocity_angle_max_deg", "kept", "error_1", "title")
# What of a class says something of the severity along the car's axis.
SEVERITY = ("peak_g", "crush_mm", "olc_g", "dvx_m_s", "delta_v_m_s", "restitution_1")
# Where the parameter sets are compared: two equal cars, km/h each and overlap.
GRID = {"offset": ((40, 0.4), (40, 0.55), (56, 0.4), (56, 0.55)),
        "low_speed_offset": ((12, 0.3), (12, 0.5), (20, 0.3), (20, 0.5), (28, 0.3), (28, 0.5))}


def read(path):
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def path_of(vehicle):
    for folder in (VEHICLES, VEHICLES / "fleet"):
        if (folder / f"{vehicle}.yaml").exists():
            return folder / f"{vehicle}.yaml"
    raise SystemExit(f"{vehicle}: no vehicle file")


def relative_error(row):
    """Mean absolute error of a row over its reference; of a restitution e that of 1 + e, which goes with
    the change of velocity."""
    if row["mean_abs"] == "" or row["reference"] == "" or row["quantity"] not in SEVERITY:
        return 0.0
    mean_abs, reference = float(row["mean_abs"]), float(row["reference"])
    if row["error_unit"] == "%":
        return mean_abs / 100.0
    return mean_abs / (1.0 + reference if row["quantity"] == "restitution_1" else abs(reference))


def judged(scorecard):
    """{(class, vehicle): (bars kept, error)} of the classes that have bars."""
    result = {}
    for row in scorecard:
        if row["result"] not in ("kept", "missed"):
            continue
        kept, error = result.get((row["class"], row["vehicle"]), (True, 0.0))
        result[row["class"], row["vehicle"]] = (kept and row["result"] == "kept", max(error, relative_error(row)))
    return result


# ---- spread over the ensemble ---------------------------------------------------------------

def members(text):
    """The car itself and the parameter sets of its ensemble, as texts of vehicle files."""
    head, _, tail = text.partition("ensemble:")
    rows = re.findall(r"- \{name: (\w+), values: \[([^\]]*)\]", tail)
    yield head
    for number in range(len(rows[0][1].split(",")) if rows else 0):
        member = head
        for name, values in rows:
            value = values.split(",")[number].strip()
            member = re.sub(rf"(name: {name}, value: )[^,]+", rf"\g<1>{value}", member)
        yield member


def olc_g(crashpulse, path, speed_km_h, overlap_1, width_m):
    output = subprocess.run([crashpulse, "crash", path, "--against", path, "--speed", str(speed_km_h), "--offset",
                             f"{1000 * width_m * (1 - overlap_1):.1f}", "--format", "json"],
                            check=True, capture_output=True, text=True).stdout
    vehicle = json.loads(output)["vehicles"][0]
    return vehicle["olc_g"] or 0.0


def spreads(crashpulse, vehicle):
    """{class: standard deviation of OLC over its parameter sets over its mean, root mean square over the
    grid}, NAN without an ensemble."""
    text = path_of(vehicle).read_text(encoding="utf-8")
    width_m = float(re.search(r"name: width_m, value: ([\d.]+)", text).group(1))
    sets = list(members(text))
    result = dict.fromkeys(GRID, math.nan)
    if len(sets) < 3:
        return result
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for number, member in enumerate(sets):
            paths.append(pathlib.Path(folder) / f"{number}.yaml")
            paths[-1].write_text(member, encoding="utf-8")
        for name, grid in GRID.items():
            values = [[olc_g(crashpulse, path, speed_km_h, overlap_1, width_m) for path in paths]
                      for speed_km_h, overlap_1 in grid]
            result[name] = math.sqrt(sum(map(statistics.variance, values)) /
                                     sum(statistics.mean(row) ** 2 for row in values))
    return result


def fill(spread):
    """A vehicle with less than two parameter sets beside its own has the largest spread of the others."""
    for name in GRID:
        known = [values[name] for values in spread.values() if not math.isnan(values[name])]
        for values in spread.values():
            if math.isnan(values[name]):
                values[name] = max(known)


# ---- the table ------------------------------------------------------------------------------

def table(scorecard, boxes, spread):
    classes = judged(scorecard)
    for vehicle, sha in {row["vehicle"]: hashlib.sha256(path_of(row["vehicle"]).read_bytes()).hexdigest()
                         for row in scorecard}.items():
        for box in boxes:
            if any((name, vehicle) not in classes for name in box["requires"].split()):
                continue    # a class that does not judge this vehicle
            required = [classes[name, vehicle] for name in box["requires"].split()]
            pulse = [classes[name, vehicle] for name in box["pulse_of"].split() if (name, vehicle) in classes]
            error = max(error for _, error in required + pulse)
            if box["spread"] == "yes":
                name = "low_speed_offset" if box["class"].startswith("low_speed") else "offset"
                error = math.hypot(error, spread[vehicle][name])
            yield {**box, "vehicle": vehicle, "vehicle_sha256": sha, "error_1": f"{error:.4f}",
                   "kept": int(all(kept for kept, _ in required))}


def main():
    parser = argparse.ArgumentParser(description="which crashes the tests speak for, and with which error")
    parser.add_argument("crashpulse")
    parser.add_argument("--output", type=pathlib.Path, default=HERE)
    arguments = parser.parse_args()
    scorecard, boxes = read(HERE / "scorecard.csv"), read(HERE / "boxes.csv")
    spread = {vehicle: spreads(arguments.crashpulse, vehicle) for vehicle in {row["vehicle"] for row in scorecard}}
    fill(spread)
    text = io.StringIO()
    text.write("# Which crashes the tests speak for; made by evidence.py, do not edit. Columns: README.md, boxes.csv.\n")
    writer = csv.DictWriter(text, COLUMNS, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(table(scorecard, boxes, spread))
    (arguments.output / "evidence.csv").write_text(text.getvalue(), encoding="utf-8")


if __name__ == "__main__":
    main()
