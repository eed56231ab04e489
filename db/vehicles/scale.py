#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes small_car.yaml, suv.yaml and van.yaml beside itself, scaled from another vehicle file:

    python3 db/vehicles/scale.py db/vehicles/honda_accord_2014.yaml

Two ratios to the base make a vehicle: its mass, and the length of its front (of all that collapses
and of the gaps in it). Forces go with mass over length of the front: every kilogram has the same
work of collapse ahead of it, and a barrier at equal speed uses up the same share of the front. So a
front of equal length gives the base's pulse, a shorter one a harder pulse. What lies across the car
goes with its width. What is not scaled is as in the base. Nothing of this is a validation."""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent

# Mass as it crashes, kg; length and width, m; length of the front over the base's. All assumed.
VEHICLES = {
    "small_car": ("small car (B segment)", 1230, 4.00, 1.73, 0.90, "short front of the segment",
                  "kerb mass of about 1080 kg and two occupants"),
    "suv": ("large SUV", 2150, 4.90, 1.95, 1.00, "front as long as the base's",
            "kerb mass of about 2000 kg and two occupants"),
    "van": ("transporter van", 2350, 5.30, 1.99, 0.90, "short front of a transporter",
            "kerb mass of about 2100 kg, driver and some load"),
}

LENGTH, WIDTH, MASS, FORCE, MOMENT, SLOPE = "length", "width", "mass", "force", "moment", "slope"
KINDS = {
    LENGTH: "longitudinal_length_m longitudinal_collapse_begin_m longitudinal_collapse_end_m "
            "crash_box_length_m crash_box_collapse_begin_m crash_box_collapse_end_m "
            "engine_gap_front_m engine_gap_firewall_m corner_gap_m corner_collapse_begin_m "
            "corner_collapse_end_m bumper_stroke_m upper_gap_m upper_collapse_begin_m upper_collapse_end_m",
    WIDTH: "longitudinal_y_m cross_member_half_width_m engine_width_m corner_width_m corner_side_m",
    MASS: "longitudinal_mass_kg crash_box_mass_kg cross_member_mass_kg engine_mass_kg "
          "contact_stiffness_kn_m body_stiffness_kn_m",
    FORCE: "longitudinal_collapse_begin_kn longitudinal_collapse_middle_kn "
           "longitudinal_collapse_end_kn bumper_kn corner_side_kn cell_edge_kn cell_kn crash_box_collapse_begin_kn "
           "crash_box_collapse_end_kn engine_mount_yield_kn corner_collapse_begin_kn "
           "corner_collapse_end_kn upper_collapse_begin_kn upper_collapse_end_kn "
           "engine_cradle_kn engine_mount_damping_kn_s_m",
    MOMENT: "longitudinal_bending_kn_m cross_member_bending_kn_m",
    SLOPE: "engine_mount_kn_m firewall_stiffness_kn_m stop_stiffness_kn_m",
}
KIND_OF = {name: kind for kind, names in KINDS.items() for name in names.split()}
WORDS = {
    LENGTH: "length of the front", WIDTH: "width", MASS: "mass",
    FORCE: "mass over length of the front", MOMENT: "force times length of the front",
    SLOPE: "force over length of the front",
}

# Relative standard deviations, assumed: load and manufacture, more for what is known least.
SCATTER = {
    "mass_kg": 0.03, "yaw_inertia_kg_m2": 0.05, "cg_to_front_m": 0.01,
    "longitudinal_collapse_begin_kn": 0.08, "longitudinal_collapse_end_kn": 0.08,
    "longitudinal_bending_kn_m": 0.10, "crash_box_collapse_begin_kn": 0.08,
    "crash_box_collapse_end_kn": 0.08, "corner_collapse_begin_kn": 0.15,
    "corner_collapse_end_kn": 0.15, "engine_gap_front_m": 0.05, "friction_1": 0.20,
}


SMALLEST = {}  # of every parameter, from the table of the vehicle model


def base_vehicle(path):
    """Name of the base and all its parameters: {name: (unit, value)}; standard where not named."""
    header = (HERE.parent.parent / "src/crash/vehicle_model.h").read_text()
    table = re.findall(r'X\((\w+), "([^"]*)", ([-\d.]+), ([-\d.]+),', header.replace("\\\n", " "))
    values = {name: (unit, float(value)) for name, unit, value, _ in table}
    SMALLEST.update({name: float(smallest) for name, _, _, smallest in table})
    text = re.sub(r"#.*", "", path.read_text())
    for name, value in re.findall(r"name:\s*(\w+)\W+value:\s*([-+\d.eE]+)", text.split("\nensemble:")[0]):
        values[name] = (values[name][0], float(value))
    return re.search(r"^vehicle:\s*(\S+)", text, re.M).group(1), values


def shown(value):
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def scaled(base, values, mass, length, width, front, mass_source):
    """Rows (name, unit, value, source) in the order of the table."""
    old = {name: value for name, (_, value) in values.items()}
    mass_ratio, width_ratio = mass / old["mass_kg"], width / old["width_m"]
    ratios = {LENGTH: front, WIDTH: width_ratio, MASS: mass_ratio, FORCE: mass_ratio / front,
              MOMENT: mass_ratio, SLOPE: mass_ratio / front ** 2}
    gyration = (length ** 2 + width ** 2) / (old["length_m"] ** 2 + old["width_m"] ** 2)
    share = old["cg_to_front_m"] / old["length_m"]
    own = {
        "mass_kg": (mass, f"assumed: {mass_source}"),
        "length_m": (length, "assumed: typical outline"),
        "width_m": (width, "assumed: typical outline"),
        "yaw_inertia_kg_m2": (old["yaw_inertia_kg_m2"] * mass_ratio * gyration,
                              f"{base} x {mass_ratio * gyration:.3f} (mass x (length2 + width2))"),
        "unload_end_factor_1": (
            max(old["unload_factor_1"], old["unload_end_factor_1"] * min(1.0, front ** 2)),
            f"{base} x {min(1.0, front ** 2):.3f} (stiffness the time step stands)"),
        "cg_to_front_m": (share * length, f"{share:.3f} of the length, as {base}"),
    }
    for name, (unit, value) in values.items():
        if name in own:
            yield (name, unit, *own[name])
        elif name in KIND_OF:
            ratio = ratios[KIND_OF[name]]
            source = f"{base} x {ratio:.3f} ({WORDS[KIND_OF[name]]})"
            if value * ratio < SMALLEST[name]:
                source += ", not below the model's smallest"
            yield name, unit, max(value * ratio, SMALLEST[name]), source
        else:
            yield name, unit, value, f"as {base}"


def main():
    base, values = base_vehicle(pathlib.Path(sys.argv[1]))
    for name, (title, mass, length, width, front, front_source, mass_source) in VEHICLES.items():
        lines = [
            f"# A {title}, scaled from {base} by scale.py, which says how. Fitted to no test and "
            "not validated:", "# its results are marked as outside of every calibrated range. "
            f"Length of the front: {front:g} of {base}'s,", f"# assumed ({front_source}). Scatter "
            "is assumed too.",
            f"vehicle: {name}",
            f'description: "{title}, scaled from {base} by mass and size; not calibrated, not '
            'validated"', "parameters:"]
        for key, unit, value, source in scaled(base, values, mass, length, width, front, mass_source):
            scatter = f", scatter: {SCATTER[key]:g}" if key in SCATTER else ""
            unit = '"1"' if unit == "1" else unit
            lines.append(f'  - {{name: {key}, value: {shown(value)}, unit: {unit}, '
                         f'source: "{source}"{scatter}}}')
        (HERE / f"{name}.yaml").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
