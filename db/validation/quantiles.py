#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the tables a suite is judged by from single tests that do not ship.

    python3 db/validation/quantiles.py [REFERENCES] [--output FOLDER | --axes]

REFERENCES (default ../shared/reference beside the project) holds iihs_small_overlap/velocities.csv,
nhtsa_frontal/crush_and_peak.csv, nhtsa_crush/crush.csv, car_to_car/nhtsa_oblique.csv and
car_to_car/reconstructed.csv. Written to FOLDER (default: here): quantiles.csv, nhtsa_oblique.csv,
reconstructed.csv, reconstructed_struck.csv. Quantiles are linear between the sorted values (rank (n - 1) p), as numpy and R type 7 have them."""
import argparse
import csv
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
TIMES_MS = (20, 40, 60, 80, 100, 120, 150)
FOOT_M = 0.3048

QUANTILES_SOURCE = """\
# Quantiles of crash test populations; made by quantiles.py, do not edit.
# small_overlap_*: IIHS small-overlap rating tests (64.4 km/h, 25 % of the vehicle's width, rigid
#   wall, end rounded with 150 mm): change of velocity along the vehicle's x (slower is positive)
#   and sideways away from the barrier, by accelerometers that turn with the car. Source: tests of
#   the Insurance Institute for Highway Safety as derived by github.com/yangduhi/IIHS_SOL.
# wall_*: vehicles of 2011 and later into a rigid wall, full width: wall_40 38.5-40.6 km/h, wall_56
#   55-58 km/h, wall_30deg_40 39.5-40.7 km/h with the wall turned by 30 degrees either way. crush_mm:
#   integral of the velocity along x while it is positive, at most 300 ms; peak_g: CFC60. Source:
#   US DOT NHTSA vehicle crash tests as derived by github.com/yangduhi/pulse_analysis.
# mdb_side_*: sides struck by the moving deformable barrier of FMVSS 214 at 60-64 km/h, largest static
#   crush; pole_side_*: sides driven against a pole at 75 degrees, 30.9-32.9 km/h, likewise; sedan:
#   sedans and coupes, light: all of the tests. Source: US DOT NHTSA vehicle crash tests as republished by github.com/yangduhi/side_loadcell.
"""
OBLIQUE_SOURCE = """\
# Two cars near 56 km/h, headings 30 to 32 degrees from oncoming: US DOT NHTSA tests 4363, 4364, 4438
# as evaluated in Rose et al., "Restitution Modeling for Crush Analysis", SAE 2006-01-0908. Made by
# quantiles.py (feet into metres); do not edit. Impact centre by distance and angle (counter-clockwise
# from the car's x axis) from each centre of gravity.
"""
RECONSTRUCTED_SOURCE = """\
# Real crashes of two cars, front against front: reconstructions, not measurements. Taken by
# quantiles.py from Q. Wang et al., "Human injury-based safety decision of automated vehicles",
# iScience 2022, supplement A7, CC BY 4.0 (https://creativecommons.org/licenses/by/4.0/); both rows of
# a crash in one, columns of persons left out, directions of travel made a heading difference.
"""
STRUCK_SOURCE = """\
# Real crashes of two cars, the first struck on its side or rear by the front of the second:
# reconstructions, not measurements; source and makers as of reconstructed.csv. angle_deg: heading of the
# second against square to the struck side, counter-clockwise.
"""
INWARDS_DEG = {"Left-side": -90.0, "Right-side": 90.0, "Rear": 0.0}


def quantile(values, share):
    values = sorted(values)
    rank = (len(values) - 1) * share
    low = math.floor(rank)
    high = min(low + 1, len(values) - 1)
    return values[low] + (rank - low) * (values[high] - values[low])


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def numbers(rows, column, sign=1.0):
    return [sign * float(row[column]) for row in rows if row[column] != ""]


def small_overlap(references):
    tests = read(references / "iihs_small_overlap" / "velocities.csv")
    for population, begin in (("small_overlap_driver", "CEN"), ("small_overlap_passenger", "CEP")):
        rows = [row for row in tests if row["test_code"].startswith(begin)]
        for quantity, column, sign in (("dvx_m_s", "dvx", -1.0), ("dvy_away_m_s", "dvy_away", 1.0)):
            for time_ms in TIMES_MS:
                yield population, quantity, time_ms, numbers(rows, f"{column}_{time_ms:03}_m_s", sign)


def walls(references):
    tests = read(references / "nhtsa_frontal" / "crush_and_peak.csv")
    for population, slowest, fastest, angles in (("wall_40", 38.5, 40.6, (0.0,)),
                                                 ("wall_56", 55.0, 58.0, (0.0,)),
                                                 ("wall_30deg_40", 39.5, 40.7, (30.0, 330.0))):
        rows = [row for row in tests if slowest <= float(row["speed_km_h"]) <= fastest
                and float(row["angle_deg"]) in angles]
        for quantity, column in (("peak_g", "peak_g"), ("crush_mm", "dynamic_crush_mm"),
                                 ("speed_km_h", "speed_km_h")):
            yield population, quantity, "", numbers(rows, column)


def struck(references):
    tests = read(references / "nhtsa_crush" / "crush.csv")
    tests = [row for row in tests if row["quality_tier"] != "X_Exclude" and float(row["speed_km_h"] or 0) > 0]
    for population, role, slowest, fastest in (("mdb_side", "struck_by_mdb", 60.0, 64.0),
                                               ("pole_side", "into_pole", 30.9, 32.9)):
        rows = [row for row in tests if row["crash_role"] == role and slowest <= float(row["speed_km_h"]) <= fastest
                and float(row["max_crush_mm"]) > 0 and "weight_suspect" not in row["flags"]]
        sedans = [row for row in rows if "SEDAN" in row["body"] or "COUPE" in row["body"]]
        yield population + "_sedan", "struck_mm", "", numbers(sedans, "max_crush_mm")
        yield population + "_light", "struck_mm", "", numbers(rows, "max_crush_mm")


def quantiles(references):
    lines = ["population,quantity,time_ms,tests,p05,p25,p50,p75,p95"]
    for group in (walls, small_overlap, struck):
        for population, quantity, time_ms, values in group(references):
            figures = [quantile(values, share) for share in (.05, .25, .5, .75, .95)]
            lines.append(",".join([population, quantity, str(time_ms), str(len(values))]
                                  + [f"{figure:.4g}" for figure in figures]))
    return QUANTILES_SOURCE + "\n".join(lines) + "\n"


def oblique(references):
    lines = ["test,speed_1_m_s,heading_1_deg,speed_2_m_s,heading_2_deg,centre_1_m,centre_angle_1_deg,"
             "centre_2_m,centre_angle_2_deg,delta_v_1_m_s,yaw_rate_change_1_deg_s,delta_v_2_m_s,"
             "yaw_rate_change_2_deg_s"]
    for row in read(references / "car_to_car" / "nhtsa_oblique.csv"):
        centre = [f"{FOOT_M * float(row[f'v{car}_cg_to_impact_centre_ft']):.4f}" for car in (1, 2)]
        lines.append(",".join([
            row["test"], row["v1_speed_m_s"], row["v1_heading_deg"], row["v2_speed_m_s"],
            row["v2_heading_deg"], centre[0], row["v1_impact_centre_angle_deg"], centre[1],
            row["v2_impact_centre_angle_deg"], row["v1_delta_v_m_s"],
            row["v1_yaw_rate_change_deg_s"], row["v2_delta_v_m_s"], row["v2_yaw_rate_change_deg_s"]]))
    return OBLIQUE_SOURCE + "\n".join(lines) + "\n"


def reconstructed(references):
    lines = ["test,speed_1_m_s,speed_2_m_s,angle_deg,mass_1_kg,mass_2_kg,"
             "delta_v_1_m_s,delta_v_2_m_s"]
    cases = {}
    for row in read(references / "car_to_car" / "reconstructed.csv"):
        cases.setdefault(row["case"], []).append(row)
    for case, (one, two) in cases.items():
        if one["crash_type"] != "Frontal" or two["crash_type"] != "Frontal":
            continue
        turned = float(two["angle_deg"]) - float(one["angle_deg"]) - 180.0
        turned -= 360.0 * round(turned / 360.0)
        lines.append(",".join([case, one["speed_m_s"], two["speed_m_s"], f"{turned:g}"]
                              + [row[column] for column in ("mass_kg", "delta_v_m_s")
                                 for row in (one, two)]))
    return RECONSTRUCTED_SOURCE + "\n".join(lines) + "\n"


def reconstructed_struck(references):
    lines = ["test,struck,speed_1_m_s,speed_2_m_s,angle_deg,mass_1_kg,mass_2_kg,delta_v_1_m_s,delta_v_2_m_s"]
    cases = {}
    for row in read(references / "car_to_car" / "reconstructed.csv"):
        cases.setdefault(row["case"], []).append(row)
    for case, rows in cases.items():
        struck_rows = [row for row in rows if row["crash_type"] != "Frontal"]
        if len(struck_rows) != 1:
            continue
        one = struck_rows[0]
        two = rows[1] if rows[0] is one else rows[0]
        turned = float(two["angle_deg"]) - float(one["angle_deg"]) - INWARDS_DEG[one["crash_type"]]
        turned -= 360.0 * round(turned / 360.0)
        lines.append(",".join([case, one["crash_type"].replace("-side", "").lower(), one["speed_m_s"],
                               two["speed_m_s"], f"{turned:g}"]
                              + [row[column] for column in ("mass_kg", "delta_v_m_s") for row in (one, two)]))
    return STRUCK_SOURCE + "\n".join(lines) + "\n"


def axes(references):
    """Tests that both small-overlap tables hold: amount and direction of the change of velocity at
    separation and by accelerometers after 250 ms, in m/s and degrees from the x axis."""
    folder = references / "iihs_small_overlap"
    tests = {row["test_code"]: row for row in read(folder / "velocities.csv")}
    lines = ["test,separation_m_s,separation_deg,accelerometer_m_s,accelerometer_deg,ratio"]
    for row in read(folder / "separation.csv"):
        test = tests.get(row["test"])
        if test is None or test["dvx_250_m_s"] == "":
            continue
        pairs = ((float(row["dvx_m_s"]), float(row["dvy_m_s"])),
                 (-float(test["dvx_250_m_s"]), float(test["dvy_away_250_m_s"])))
        amounts = [math.hypot(x, y) for x, y in pairs]
        angles = [math.degrees(math.atan2(y, x)) for x, y in pairs]
        lines.append(f"{row['test']},{amounts[0]:.2f},{angles[0]:.1f},{amounts[1]:.2f},{angles[1]:.1f},"
                     f"{amounts[1] / amounts[0]:.3f}")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description="quantiles of crash test populations")
    parser.add_argument("references", nargs="?", type=pathlib.Path,
                        default=HERE / ".." / ".." / ".." / "shared" / "reference")
    parser.add_argument("--output", type=pathlib.Path, default=HERE)
    parser.add_argument("--axes", action="store_true",
                        help="write nothing; print what tells the axes of the small-overlap tables")
    arguments = parser.parse_args()
    if arguments.axes:
        print(axes(arguments.references), end="")
        return
    for name, make in (("quantiles.csv", quantiles), ("nhtsa_oblique.csv", oblique),
                       ("reconstructed.csv", reconstructed),
                       ("reconstructed_struck.csv", reconstructed_struck)):
        (arguments.output / name).write_text(make(arguments.references), encoding="utf-8")


if __name__ == "__main__":
    main()
