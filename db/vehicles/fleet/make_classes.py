#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the vehicle classes of a fleet: what their populations are, where their fits start, what they aim at.

    python3 db/vehicles/fleet/make_classes.py [REFERENCES] [--output FOLDER]

REFERENCES (default ../shared/reference beside the project) holds nhtsa_crush/crush.csv,
nhtsa_frontal/crush_and_peak.csv, car_to_car/reconstructed.csv and nass_cds/frontal_car_crashes.csv; their
rows do not ship, the figures computed from them do. Written to FOLDER (default: here): classes.csv, and for every light class
CLASS.base.yaml and CLASS.fit.yaml. Then, for each of them:

    crashpulse calibrate db/vehicles/fleet/CLASS.fit.yaml

writes CLASS.yaml, and

    python3 db/vehicles/fleet/make_classes.py --sides

adds side and rear, which no fit touches. That is what ships. README.md says how."""
import argparse
import csv
import math
import pathlib
import re
import statistics

HERE = pathlib.Path(__file__).resolve().parent

# Light classes: name, title, bodies of the tests, length from and to (m) of a car that belongs to it.
CARS = ("SEDAN", "COUPE", "HATCHBACK", "WAGON")
CLASSES = (
    ("small_car", "small car, up to 4.3 m", CARS, 0.0, 4.3),
    ("compact_car", "compact car, 4.3 to 4.65 m", CARS, 4.3, 4.65),
    ("mid_size_car", "mid-size car, 4.65 to 4.92 m", CARS, 4.65, 4.92),
    ("large_car", "large car, from 4.92 m", CARS, 4.92, 9.0),
    ("suv", "sport utility vehicle", ("UTILITY",), 0.0, 9.0),
    ("pickup", "pickup", ("PICKUP",), 0.0, 9.0),
    ("van", "van up to 3.5 t", ("MINIVAN",), 0.0, 9.0),
)
GEOMETRY = (("mass_kg", "test_weight_kg", 1.0), ("length_m", "length_mm", 1e-3),
            ("width_m", "width_mm", 1e-3), ("wheelbase_m", "wheelbase_mm", 1e-3),
            ("cg_behind_axle_m", "cg_mm", 1e-3))
# Of vans two minivans were tested: panel vans up to 3.5 t are longer. Without tests, by judgement.
BY_JUDGEMENT = {"van": {"length_m": (0, 5.6, 0.4), "wheelbase_m": (0, 3.4, 0.3), "cg_behind_axle_m": (0, 1.6, 0.15)}}
SUSPECT = {"weight_suspect": "test_weight_kg", "curb_eq_test_weight": "test_weight_kg",
           "cg_suspect": "cg_mm", "cg_missing": "cg_mm", "length_or_wheelbase_suspect": "wheelbase_mm"}
FRONT_OVERHANG_1 = 0.46        # of what wheelbase leaves of the length; by judgement
QUANTITIES = (("crush_mm", "dynamic_crush_mm"), ("peak_g", "peak_g"))

CLASSES_SOURCE = """\
# Vehicle classes of a fleet, made by make_classes.py; do not edit. Mass with two dummies and their
# load, length, width, wheelbase, centre of gravity behind the front axle: makes, models and years of
# the tests counted once. wall_56, wall_40: crush of the passenger cell and peak of rigid-wall tests.
# Source: US DOT NHTSA vehicle crash tests as republished by github.com/yangduhi/side_loadcell and
# (crush and peak) derived by github.com/yangduhi/pulse_analysis. tests: what the class itself has, 0: none, by judgement;
# mean_drawn: its mean drawn towards that of all classes by its standard error (README.md), which is
# what the class aims at; sd: within classes, pooled, for crush and peak.
# yaw_inertia_1: yaw inertia over mass (length^2 + width^2), median and standard deviation of the 40
# cars of Q. Wang et al., iScience 2022, supplement A7, CC BY 4.0. market_share_1: of vehicles of model
# year 2000 and later in towed frontal crashes of two light vehicles, United States, 2010 to 2015,
# weighted (US DOT NHTSA, NASS-CDS); cars by curb mass, borders half way between the classes' means.
"""


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def robust_sd(values):
    middle = statistics.median(values)
    return 1.4826 * statistics.median(abs(value - middle) for value in values)


def without_outliers(values):
    """Beyond four robust standard deviations of all tests no car is but a broken integration."""
    middle, spread = statistics.median(values.values()), robust_sd(list(values.values()))
    return {key: value for key, value in values.items() if abs(value - middle) <= 4.0 * spread}


def class_of(row):
    if row["role"] != "subject_vehicle" or row["family"] == "rear" or not row["length_mm"]:
        return None
    length_m = 1e-3 * float(row["length_mm"])
    for name, _, bodies, shortest, longest in CLASSES:
        if any(body in row["body"] for body in bodies) and shortest <= length_m < longest:
            return name
    return None


def geometry(rows, name):
    """Mean and standard deviation of every measure, each make, model and year once."""
    cars = {(row["make"], row["model"], row["year"]): row for row in rows if class_of(row) == name}
    result = {}
    for quantity, column, factor in GEOMETRY:
        values = [factor * float(row[column]) for row in cars.values() if row[column]
                  and float(row[column]) > 0.0
                  and all(SUSPECT.get(flag) != column for flag in row["flags"].split(";"))]
        spread = statistics.stdev(values) if len(values) > 2 else math.nan
        result[quantity] = (len(values), statistics.mean(values), spread)
    result.update(BY_JUDGEMENT.get(name, {}))
    return result


def wall(rows, tests, column, slowest, fastest):
    """Values of the tests at a speed, by class; and of all tests there."""
    values = without_outliers({row["test_no"]: float(row[column]) for row in tests
                               if slowest <= float(row["speed_km_h"]) <= fastest
                               and float(row["angle_deg"]) == 0.0})
    groups = {name: [] for name, *_ in CLASSES}
    for row in rows:
        name = class_of(row)
        if name is not None and row["test_no"] in values and row["family"] == "frontal_barrier":
            groups[name].append(values[row["test_no"]])
    return groups, list(values.values())


def drawn_means(groups, everything):
    """Means of classes drawn towards the mean of all tests: m + b (mean - m), b = tau^2 / (tau^2 +
    s^2 / n), tau^2 the variance between classes by moments (DerSimonian and Laird 1986), s the
    standard deviation within classes."""
    filled = {name: values for name, values in groups.items() if len(values) > 1}
    freedom = sum(len(values) - 1 for values in filled.values())
    within = sum((len(values) - 1) * statistics.variance(values) for values in filled.values()) / freedom
    weight = {name: len(values) / within for name, values in filled.items()}
    total = sum(weight.values())
    middle = sum(weight[name] * statistics.mean(values) for name, values in filled.items()) / total
    spread = sum(weight[name] * (statistics.mean(values) - middle) ** 2 for name, values in filled.items())
    between = max(0.0, (spread - (len(filled) - 1))
                  / (total - sum(w * w for w in weight.values()) / total))
    centre = statistics.mean(everything)
    means = {}
    for name, values in groups.items():
        share = between / (between + within / len(values)) if values else 0.0
        own = statistics.mean(values) if values else centre
        means[name] = (len(values), centre + share * (own - centre), math.sqrt(within))
    return means, centre


def inertia(rows):
    shares = []
    for row in rows:
        try:
            mass, length, width, yaw = (float(row[column]) for column in
                                        ("mass_kg", "length_m", "width_m", "yaw_inertia_kg_m2"))
        except ValueError:
            continue
        shares.append(yaw / (mass * (length ** 2 + width ** 2)))
    return len(shares), statistics.median(shares), robust_sd(shares)


def market(rows, crashes):
    """Shares of the classes among vehicles in crashes, and how many vehicles they come from."""
    cars = [name for name, _, bodies, *_ in CLASSES if bodies == CARS]
    curb = [statistics.mean(float(row["curb_weight_kg"]) for row in rows
                            if class_of(row) == name and row["curb_weight_kg"]) for name in cars]
    borders = [(one + other) / 2.0 for one, other in zip(curb, curb[1:])]
    share = {name: 0.0 for name, *_ in CLASSES}
    count = dict.fromkeys(share, 0)
    for row in crashes:
        if int(row["year"]) < 2010 or not row["model_year"] or int(row["model_year"]) < 2000:
            continue
        name = row["body_class"]
        if name == "car" and row["curb_kg"]:
            name = cars[sum(float(row["curb_kg"]) >= border for border in borders)]
        if name in share:
            share[name] += float(row["ratwgt"])
            count[name] += 1
    total = sum(share.values())
    return {name: (count[name], share[name] / total, 0.0) for name in share}


def populations(references):
    """Everything that is known of the classes: {class: {quantity: (tests, mean, sd)}}."""
    rows = read(references / "nhtsa_crush" / "crush.csv")
    tests = read(references / "nhtsa_frontal" / "crush_and_peak.csv")
    yaw = inertia(read(references / "car_to_car" / "reconstructed.csv"))
    classes = {name: geometry(rows, name) for name, *_ in CLASSES}
    for quantity, column in QUANTITIES:
        groups, at_56 = wall(rows, tests, column, 55.0, 58.0)
        means, centre = drawn_means(groups, at_56)
        slow, at_40 = wall(rows, tests, column, 38.5, 40.6)
        ratio = statistics.mean(at_40) / centre
        for name, (count, mean, spread) in means.items():
            classes[name][f"wall_56_{quantity}"] = (count, mean, spread)
            # Classes have hardly a test at 40 km/h: what all tests lose from 56 to 40 they lose too.
            classes[name][f"wall_40_{quantity}"] = (len(slow[name]), ratio * mean, ratio * spread)
    shares = market(rows, read(references / "nass_cds" / "frontal_car_crashes.csv"))
    for name, figures in classes.items():
        figures["yaw_inertia_1"] = yaw
        figures["market_share_1"] = shares[name]
    fill_small_classes(classes)
    return classes


def fill_small_classes(classes):
    """A spread of less than three cars is that of all others, relative to the mean."""
    for quantity, _, _ in GEOMETRY:
        known = [spread / mean for figures in classes.values()
                 for _, mean, spread in [figures[quantity]] if not math.isnan(spread)]
        for figures in classes.values():
            count, mean, spread = figures[quantity]
            if math.isnan(spread):
                figures[quantity] = (count, mean, mean * statistics.median(known))


def table(classes):
    lines = ["class,quantity,tests,mean_drawn,sd"]
    for name, figures in classes.items():
        lines += [f"{name},{quantity},{count},{mean:.4g},{spread:.3g}"
                  for quantity, (count, mean, spread) in figures.items()]
    return CLASSES_SOURCE + "\n".join(lines) + "\n"


# ---- side and rear --------------------------------------------------------------------------

# Forces of a side: those of sedans (standard values of the program) times the ratio of the mean forces in
# moving-barrier tests at 62 km/h, by body. Of rears there are few tests and no class: they go with the mass as
# fronts do, whose crush goes with mass^0.37 in 90 tests, so that forces go with mass^0.63. Scatter of sides:
# that of the tests; of rears, what few tests show.
MODEL = HERE.parent.parent.parent / "src" / "crash" / "vehicle_model.h"
SEDAN_BARRIER_KN = 240
BARRIER_KN = {"suv": 275, "pickup": 242, "van": 276}
SIDE = ("side_front_wheel_begin_kn_m", "side_front_wheel_end_kn_m", "side_door_begin_kn_m", "side_door_end_kn_m",
        "side_rear_wheel_begin_kn_m", "side_rear_wheel_end_kn_m")
REAR = ("rear_collapse_begin_kn", "rear_collapse_end_kn")
REAR_TESTS_KG, MASS_EXPONENT_1 = 1820, 0.63
SIDE_SCATTER_1, REAR_SCATTER_1 = 0.2, 0.15


def standard_values(names):
    """Of parameters, as the program has them."""
    text = MODEL.read_text(encoding="utf-8")
    return {name: float(re.search(rf"X\({name}, \"[^\"]*\", ([\d.]+),", text).group(1)) for name in names}


def side_lines(name, mass_kg):
    """Lines of a vehicle file: side and rear of the class."""
    ratio = BARRIER_KN.get(name, SEDAN_BARRIER_KN) / SEDAN_BARRIER_KN
    of_mass = (mass_kg / REAR_TESTS_KG) ** MASS_EXPONENT_1
    source = "sedans" if ratio == 1.0 else f"sedans x {ratio:.3f}, moving-barrier tests of the body"
    lines = [f'  - {{name: {parameter}, value: {ratio * value:.4g}, unit: kN/m, source: "{source}", '
             f"scatter: {SIDE_SCATTER_1}}}" for parameter, value in standard_values(SIDE).items()]
    return lines + [f'  - {{name: {parameter}, value: {of_mass * value:.4g}, unit: kN, source: "standard x {of_mass:.3f}, '
                    f'(mass / {REAR_TESTS_KG})^{MASS_EXPONENT_1}", scatter: {REAR_SCATTER_1}}}'
                    for parameter, value in standard_values(REAR).items()]


def add_sides(path, name):
    """Side and rear into a fitted vehicle file, in place of what is there of them."""
    text = path.read_text(encoding="utf-8")
    mass_kg = float(re.search(r"name: mass_kg, value: ([\d.]+)", text).group(1))
    lines = [line for line in text.splitlines()
             if not any(f"name: {parameter}, value" in line for parameter in SIDE + REAR)]
    last = max(number for number, line in enumerate(lines) if "value:" in line)
    path.write_text("\n".join(lines[:last + 1] + side_lines(name, mass_kg) + lines[last + 1:]) + "\n", encoding="utf-8")


# ---- base and fit ---------------------------------------------------------------------------

def parameters_of(path):
    """Name, value and unit of the parameters of a vehicle file, one a line."""
    pattern = re.compile(r"- \{name: (\w+), value: ([^,}]+), unit: ([^,}]+)")
    return [(m.group(1), float(m.group(2)), m.group(3).strip())
            for m in map(pattern.search, path.read_text(encoding="utf-8").splitlines()) if m]


# What scatters within a class beside the mass, as a share of the value: chosen so that crush and peak at
# 56 km/h scatter as the tests of a class do (README.md names the command and what comes of it).
FORCE_SCATTER_1 = 0.45
LENGTH_SCATTER_1 = 0.25
SCATTER = {"longitudinal_collapse_begin_kn": FORCE_SCATTER_1, "longitudinal_collapse_end_kn": FORCE_SCATTER_1,
           "longitudinal_collapse_middle_kn": FORCE_SCATTER_1, "upper_collapse_end_kn": FORCE_SCATTER_1,
           "firewall_stiffness_kn_m": FORCE_SCATTER_1, "corner_collapse_begin_kn": FORCE_SCATTER_1,
           "engine_gap_front_m": LENGTH_SCATTER_1, "engine_gap_firewall_m": LENGTH_SCATTER_1}
FRONT_LENGTHS = ("longitudinal_length_m", "longitudinal_collapse_end_m", "upper_collapse_end_m",
                 "corner_collapse_end_m", "engine_gap_front_m", "engine_gap_firewall_m")
WIDTHS = ("cross_member_half_width_m", "longitudinal_y_m", "engine_width_m", "corner_width_m")
MASSES = ("longitudinal_mass_kg", "crash_box_mass_kg", "cross_member_mass_kg", "engine_mass_kg")
OF_THE_CELL = ("cell_edge_kn", "cell_kn", "contact_stiffness_kn_m")


def start_of(figures, base):
    """The car the fit starts from: measures of the class, the front of the mid-size car."""
    mass, length, width = (figures[q][1] for q in ("mass_kg", "length_m", "width_m"))
    values = {name: value for name, value, _ in base}
    of_mass = mass / values["mass_kg"]
    of_front = max(0.85, min(1.2, figures["wall_56_crush_mm"][1] / 665.0))
    of_width = width / values["width_m"]
    wheelbase, behind_axle = figures["wheelbase_m"][1], figures["cg_behind_axle_m"][1]
    given = {"mass_kg": mass, "length_m": length, "width_m": width,
             "yaw_inertia_kg_m2": figures["yaw_inertia_1"][1] * mass * (length ** 2 + width ** 2),
             "cg_to_front_m": FRONT_OVERHANG_1 * (length - wheelbase) + behind_axle}
    rows = []
    for name, value, unit in base:
        if name in given:
            source, value = "class (classes.csv)", given[name]
        elif name in FRONT_LENGTHS:
            source, value = "mid_size, by the crush of the class", value * of_front
        elif name in WIDTHS:
            source, value = "mid_size, by the width", value * of_width
        elif name in MASSES or name in OF_THE_CELL:
            source, value = "mid_size, by the mass", value * of_mass
        elif name.endswith("_kn"):
            source, value = "mid_size, by mass over crush, where a fit starts", value * of_mass / of_front
        else:
            source = "mid_size"
        rows.append((name, value, unit, source))
    return rows


def base_yaml(name, title, figures, base):
    count = figures["mass_kg"][0]
    lines = [f"# Start of the fit of the class {name}; made by make_classes.py, do not edit. Measures: {count} cars",
             "# of classes.csv; front: mid_size, until the fit.", f"vehicle: {name}_base",
             f'description: "start of the fit of the class {name} ({title}), not calibrated, not to be used for results"',
             "barrier: {width_m: 2, depth_m: 1.5, corner_radius_m: 0.15, pivot_m: 0}", "parameters:"]
    for parameter, value, unit, source in start_of(figures, base):
        text = f"{value:.4g}"
        scatter = ""
        if parameter == "mass_kg":
            mean, spread = figures["mass_kg"][1:]
            scatter = f", min: {mean - 2 * spread:.0f}, max: {mean + 2 * spread:.0f}, scatter: {spread / mean:.3f}"
        elif parameter in SCATTER:
            scatter = f", scatter: {SCATTER[parameter]}"
        unit = '"1"' if unit == "1" else unit
        lines.append(f'  - {{name: {parameter}, value: {text}, unit: {unit}, source: "{source}"{scatter}}}')
    return "\n".join(lines) + "\n"


def corridor(figures, quantity):
    mean, spread = figures[quantity][1:]
    return f"min: {mean - 1.645 * spread:.4g}, max: {mean + 1.645 * spread:.4g}, aim: {mean:.4g}"


def fit_yaml(name, title, figures, model):
    """The mid-size car's fit file with the class's aims at the walls."""
    text = model[model.index("seed: 5"):]
    crush = figures["wall_56_crush_mm"][1]
    ratio = crush / 665.0
    text = text.replace("starts: 16", "starts: 6").replace("offspring: 6", "offspring: 3")
    text = text.replace("slope_evaluations: 600", "slope_evaluations: 400").replace("ensemble: 6", "ensemble: 3")
    text = text.replace("threads: 2", "threads: 1")
    source = ("NHTSA wall tests of the class, 5 to 95 % of a normal distribution; db/vehicles/fleet/classes.csv")
    text = re.sub(r"NHTSA wall tests: 5 to 95 % of the population, aims its medians; "
                  r"db/validation/quantiles.csv", source, text)
    for speed, begin in (("40", "wall 40"), ("56", "wall 56")):
        head, tail = text.split(f"name: {begin}", 1)
        for quantity in ("peak_g", "crush_mm"):
            tail = re.sub(rf"\{{quantity: {quantity}, [^}}]*\}}",
                          f"{{quantity: {quantity}, {corridor(figures, f'wall_{speed}_{quantity}')}}}", tail, count=1)
        text = f"{head}name: {begin}{tail}"
    text = re.sub(r"\{quantity: t_v0_ms, [^}]*\}", "{quantity: t_v0_ms, min: %.3g, max: %.3g, aim: %.3g}"
                  % (60 * ratio, 80 * ratio, 70 * ratio), text)
    width = figures["width_m"][1]
    offset_mm = 1000.0 * (1.0 + 0.25 * width)      # a quarter of the width meets a wall of 2 m
    text = text.replace("offset_mm: 1462.5", f"offset_mm: {offset_mm:.1f}")
    for bound, by in (("engine_gap_front_m, min: 0.15, max: 0.45", ratio), ("corner_width_m, min: 0.2, max: 0.46", width / 1.85)):
        low, high = re.findall(r"[\d.]+", bound)
        key = bound.split(",")[0]
        text = text.replace(bound, f"{key}, min: {float(low) * min(1, by):.3g}, max: {float(high) * by:.3g}")
    head = f"""\
# Fit of the class {name}; made by make_classes.py, do not edit. As ../mid_size.fit.yaml, the aims at the
# walls and the measures are the class's; small overlap and restitution are those of all cars.
fit: {name}
description: "vehicle class: {title}; fitted to the class's wall tests at 40 and 56 km/h, small overlap, restitution"
base: {name}.base.yaml
calibrated:
  speed_min_km_h: 35
  speed_max_km_h: 60
  offset_max_mm: 0
  angle_max_deg: 0
  reason: "walls at 40 and 56 km/h, full width; what further tests say: db/validation/scorecard.md"
output: {name}.yaml
"""
    return head + text


def main():
    parser = argparse.ArgumentParser(description="vehicle classes of a fleet from crash tests")
    parser.add_argument("references", nargs="?", type=pathlib.Path,
                        default=HERE / ".." / ".." / ".." / ".." / "shared" / "reference")
    parser.add_argument("--output", type=pathlib.Path, default=HERE)
    parser.add_argument("--sides", action="store_true", help="add side and rear to the fitted files, nothing else")
    arguments = parser.parse_args()
    if arguments.sides:
        for name, *_ in CLASSES:
            add_sides(arguments.output / f"{name}.yaml", name)
        return
    classes = populations(arguments.references)
    base = parameters_of(HERE.parent / "mid_size.yaml")
    model = (HERE.parent / "mid_size.fit.yaml").read_text(encoding="utf-8")
    (arguments.output / "classes.csv").write_text(table(classes), encoding="utf-8")
    for name, title, *_ in CLASSES:
        figures = classes[name]
        (arguments.output / f"{name}.base.yaml").write_text(base_yaml(name, title, figures, base), encoding="utf-8")
        (arguments.output / f"{name}.fit.yaml").write_text(fit_yaml(name, title, figures, model), encoding="utf-8")


if __name__ == "__main__":
    main()
