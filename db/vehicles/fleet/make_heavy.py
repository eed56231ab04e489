#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the heavy classes of a fleet: delivery van over 3.5 t, rigid truck, tractor with trailer, bus.

    python3 db/vehicles/fleet/make_heavy.py [--output FOLDER]

Nothing is fitted: no crash test of a heavy vehicle's front is at hand. Every figure below is by judgement
within what its source allows, and the files have no calibrated range, so that every severity of theirs and
of their opponents is marked. README.md, "Heavy classes"."""
import argparse
import pathlib

from make_classes import HERE, SIDE, parameters_of, standard_values

WEIGHTS = "between empty and the limit of Directive 96/53/EC, by judgement"
SIZES = "SUMO's standard size of the class (vClass)"
BOX = "mass (length^2 + width^2) / 12, an even box; a tractor and its trailer turn as one"
FRAME = "front underrun protection stands at least the test forces of UN Regulation 93, frame behind it; by judgement"
BODY = "by judgement; UN Regulation 58 asks 100 to 180 kN of each point of a rear underrun guard"

# name: title, mass, its least and largest, length, width, centre of gravity behind the front (share of the
# length), one frame rail at the beginning and end of its collapse, one box, upper front, cell, engine;
# underride: the share of a struck side's and rear's force that a car does not meet, because it goes under.
HEAVY = {
    "delivery_van": ("delivery van over 3.5 t", 4800, 3600, 7400, 7.0, 2.2, 0.45, (90, 220), (50, 80), (12, 110), 600, 350,
                     (0.0, 0.0)),
    "rigid_truck": ("rigid truck", 12000, 6000, 26000, 8.0, 2.5, 0.45, (250, 600), (120, 200), (40, 200), 1500, 600,
                    (0.6, 0.3)),
    "tractor_trailer": ("tractor with trailer", 28000, 14000, 40000, 16.5, 2.55, 0.5, (300, 700), (140, 240), (40, 200),
                        1800, 600, (0.7, 0.3)),
    "bus": ("bus", 14000, 9000, 19000, 12.0, 2.5, 0.52, (120, 300), (60, 100), (20, 150), 800, 300,
            (0.2, 0.2)),
}


def values_of(mass, length, width, cg, rail, box, upper, cell, engine, underride):
    """Parameters that differ from the mid-size car's, with their sources."""
    return {
        "mass_kg": (mass, WEIGHTS), "yaw_inertia_kg_m2": (mass * (length ** 2 + width ** 2) / 12, BOX),
        "length_m": (length, SIZES), "width_m": (width, SIZES), "cg_to_front_m": (cg * length, "by judgement"),
        "longitudinal_y_m": (0.45, "frame of a truck, by judgement"),
        "longitudinal_mass_kg": (60, "by judgement"), "crash_box_mass_kg": (25, "by judgement"),
        "cross_member_mass_kg": (40, "by judgement"), "engine_mass_kg": (engine, "by judgement"),
        "longitudinal_collapse_begin_m": (0.03, "by judgement"),
        "longitudinal_collapse_begin_kn": (rail[0], FRAME),
        "longitudinal_collapse_middle_kn": (sum(rail) / 2, FRAME), "longitudinal_collapse_end_kn": (rail[1], FRAME),
        "longitudinal_bending_kn_m": (80, FRAME), "crash_box_collapse_begin_kn": (box[0], FRAME),
        "crash_box_collapse_end_kn": (box[1], FRAME), "bumper_kn": (40, "by judgement"),
        "cross_member_half_width_m": (0.44 * width, "beam of the underrun protection"),
        "cross_member_bending_kn_m": (15, FRAME), "upper_collapse_begin_kn": (upper[0], "by judgement"),
        "upper_collapse_end_kn": (upper[1], "by judgement"), "corner_collapse_begin_kn": (40, "by judgement"),
        "corner_collapse_end_kn": (60, "by judgement"), "cell_kn": (cell, "by judgement"),
        "cell_edge_kn": (cell / 3, "by judgement"), "contact_stiffness_kn_m": (20000, "four times the beam's mass"),
        "body_stiffness_kn_m": (1000, BODY), "body_damping_1": (0.2, BODY), **struck(*underride),
    }


def struck(side, rear):
    """Side and rear, less what goes under them: twice a sedan's side; rear by its guard, then the frame."""
    source = "{:.0%} underride; " + BODY
    values = {parameter: (2.0 * value * (1.0 - side), source.format(side)) for parameter, value in standard_values(SIDE).items()}
    for parameter, value in (("rear_bumper_kn", 300), ("rear_collapse_begin_kn", 300), ("rear_collapse_end_kn", 1000)):
        values[parameter] = (value * (1.0 - rear), source.format(rear))
    return values


def vehicle_yaml(name, row, base):
    title, mass, least, largest, length, width, *rest = row
    given = values_of(mass, length, width, *rest)
    lines = ["# Made by make_heavy.py; do not edit. Fitted to nothing: see README.md, \"Heavy classes\".",
             f"vehicle: {name}", f'description: "vehicle class: {title}; by judgement, not calibrated"', "parameters:"]
    known = {parameter for parameter, *_ in base}
    rows = base + [(parameter, value, "kN/m" if parameter.endswith("_kn_m") else "kN")
                   for parameter, (value, _) in given.items() if parameter not in known]
    for parameter, value, unit in rows:
        value, source = given.get(parameter, (value, "mid_size"))
        scatter = ""
        if parameter == "mass_kg":
            scatter = f", min: {least}, max: {largest}, scatter: {(largest - least) / 4 / mass:.3f}"
        unit = '"1"' if unit == "1" else unit
        lines.append(f'  - {{name: {parameter}, value: {value:.5g}, unit: {unit}, source: "{source}"{scatter}}}')
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description="heavy vehicle classes")
    parser.add_argument("--output", type=pathlib.Path, default=HERE)
    arguments = parser.parse_args()
    base = parameters_of(HERE.parent / "mid_size.yaml")
    for name, row in HEAVY.items():
        (arguments.output / f"{name}.yaml").write_text(vehicle_yaml(name, row, base), encoding="utf-8")


if __name__ == "__main__":
    main()
