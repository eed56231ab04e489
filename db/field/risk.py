#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit the injury risk of belted drivers to the NASS-CDS extract and write risk.csv.

    python3 db/field/risk.py [REFERENCES] [--output FILE] [--sql]

REFERENCES (default ../shared/reference beside the project) holds nass_cds/frontal_car_crashes.csv;
its risk set is fitted: drivers with lap and shoulder belt of front-damaged light vehicles, crashes of
two, MAIS known. Logistic regressions, weighted with the national inflation factors, by Newton's
method with step halving. Covariance: Taylor linearisation of the weighted scores, primary sampling
units as clusters within their strata (27 in 12: 15 degrees of freedom).

delta_v: delta-v alone. delta_v_type_age_sex: with the crash type (front-front 0), age (under 35: 0)
and sex (male: 0). MAIS levels count every death.

Written, one row a coefficient: model, level, drivers, injured, freedom, term, coefficient, share (of
the weighted drivers of the risk set in that class, for who does not know age and sex), then the row
of the covariance matrix, lower triangle, blanks after. --sql prints model, level, coefficients, terms,
covariance and degrees of freedom as table risk_function of a database holds them instead."""
import argparse
import csv
import json
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
THING = {"front-side": "crash_type", "front-rear": "crash_type", "age": "age", "female": "sex"}
LEVELS = {"MAIS2+": 2, "MAIS3+": 3, "fatal": 7}
DELTA_V = ("delta_v_km_h",)
TYPE = ("front-side", "front-rear")
DRIVER = ("age 35-54", "age 55-69", "age 70+", "female")
MODELS = {"delta_v": DELTA_V, "delta_v_type_age_sex": DELTA_V + TYPE + DRIVER}
SOURCE = "fitted to NASS-CDS 2000-2015 by db/field/risk.py"


class Driver:
    """A row of the risk set."""

    def __init__(self, row):
        self.weight = float(row["ratwgt"])
        self.psu = row["id"].split("-")[1]
        self.delta_v = float(row["dv_total_kmh"])
        self.crash_type = {"FF": "front-front", "FS": "front-side", "FR": "front-rear"}.get(row["crash_type"], "")
        self.age = float(row["driver_age"]) if row["driver_age"] else None
        self.sex = row["driver_sex"]
        self.fatal = row["driver_fatal"] == "1"
        self.mais = int(row["driver_mais"]) if row["driver_mais"] else None

    def injured(self, level):
        known = self.mais is not None and self.mais <= 6
        return 1.0 if self.fatal or (known and self.mais >= LEVELS[level]) else 0.0

    def known(self, terms):
        return terms == DELTA_V or (self.crash_type and self.age is not None and self.sex)

    def value(self, term):
        if term == "delta_v_km_h":
            return self.delta_v
        if term in TYPE:
            return float(self.crash_type == term)
        if term == "female":
            return float(self.sex == "F")
        low, high = {"age 35-54": (35, 54), "age 55-69": (55, 69), "age 70+": (70, math.inf)}[term]
        return float(low <= math.floor(self.age) <= high)


def read(path):
    """The drivers of the risk set and the stratum of every primary sampling unit."""
    drivers, stratum = [], {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            stratum[row["id"].split("-")[1]] = row["psustrat"]
            if row["risk_set"] == "1":
                drivers.append(Driver(row))
    return drivers, stratum


def solve(matrix, right):
    """Gauss with pivots; right: a list of columns."""
    n = len(matrix)
    rows = [list(matrix[i]) + [column[i] for column in right] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(n):
            if k != i:
                factor = rows[k][i] / rows[i][i]
                rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i])]
    return [[rows[i][n + c] / rows[i][i] for i in range(n)] for c in range(len(right))]


def probability(x, coefficients):
    return 1.0 / (1.0 + math.exp(-sum(a * b for a, b in zip(x, coefficients))))


def likelihood(observations, coefficients):
    total = 0.0
    for x, y, weight, _ in observations:
        eta = sum(a * b for a, b in zip(x, coefficients))
        total += weight * (y * eta - max(eta, 0.0) - math.log1p(math.exp(-abs(eta))))
    return total


def derivatives(observations, coefficients):
    """Scores by primary sampling unit, and the information matrix."""
    n = len(coefficients)
    scores, information = {}, [[0.0] * n for _ in range(n)]
    for x, y, weight, psu in observations:
        p = probability(x, coefficients)
        score = scores.setdefault(psu, [0.0] * n)
        for i in range(n):
            score[i] += weight * (y - p) * x[i]
            for j in range(i + 1):
                information[i][j] += weight * p * (1.0 - p) * x[i] * x[j]
    for i in range(n):
        for j in range(i):
            information[j][i] = information[i][j]
    return scores, information


def maximise(observations):
    total = sum(o[2] for o in observations)
    share = sum(o[1] * o[2] for o in observations) / total
    coefficients = [math.log(share / (1.0 - share))] + [0.0] * (len(observations[0][0]) - 1)
    best = likelihood(observations, coefficients)
    for _ in range(100):
        scores, information = derivatives(observations, coefficients)
        gradient = [sum(s[i] for s in scores.values()) for i in range(len(coefficients))]
        step, scale = solve(information, [gradient])[0], 1.0
        while True:
            moved = [c + scale * s for c, s in zip(coefficients, step)]
            reached = likelihood(observations, moved)
            if reached >= best or scale < 1e-6:
                break
            scale /= 2.0
        coefficients, best = moved, reached
        if max(abs(scale * s) for s in step) < 1e-10:
            return coefficients
    sys.exit("risk.py: Newton's method found no maximum")


def covariance(observations, coefficients, stratum):
    """Between units within strata: n/(n-1) of the squared deviations of their summed scores."""
    n = len(coefficients)
    scores, information = derivatives(observations, coefficients)
    middle = [[0.0] * n for _ in range(n)]
    for name in set(stratum.values()):
        units = [u for u, s in stratum.items() if s == name]
        sums = [scores.get(u, [0.0] * n) for u in units]
        mean = [sum(s[i] for s in sums) / len(units) for i in range(n)]
        for i in range(n):
            for j in range(n):
                middle[i][j] += (len(units) / (len(units) - 1.0)
                                 * sum((s[i] - mean[i]) * (s[j] - mean[j]) for s in sums))
    inverse = solve(information, [[float(i == j) for i in range(n)] for j in range(n)])
    half = [[sum(inverse[i][k] * middle[k][j] for k in range(n)) for j in range(n)] for i in range(n)]
    return [[sum(half[i][k] * inverse[k][j] for k in range(n)) for j in range(n)] for i in range(n)]


def fit(drivers, stratum, terms, level):
    known = [d for d in drivers if d.known(terms)]
    observations = [([1.0] + [d.value(t) for t in terms], d.injured(level), d.weight, d.psu)
                    for d in known]
    coefficients = maximise(observations)
    total = sum(d.weight for d in known)
    return {"terms": ("intercept",) + terms, "drivers": len(known),
            "injured": int(sum(o[1] for o in observations)),
            "freedom": len(stratum) - len(set(stratum.values())),
            "coefficients": coefficients,
            "shares": [None, None] + [sum(d.weight * d.value(t) for d in known) / total
                                      for t in terms[1:]],
            "covariance": covariance(observations, coefficients, stratum)}


def digits(value):
    return "%.7g" % value


def sql_row(model, level, f):
    """What a row of table risk_function (db/schema) has of a fit."""
    terms = [{"name": t, "of": THING[t.split(" ")[0]], "add": float(digits(c)), **({} if t in TYPE else {"share": round(s, 4)})}
             for t, c, s in list(zip(f["terms"], f["coefficients"], f["shares"]))[2:]]
    triangle = [float(digits(f["covariance"][i][j])) for i in range(len(f["terms"]))
                for j in range(i + 1)]
    pair = [float(digits(c)) for c in f["coefficients"][:2]]
    return model, level, json.dumps(pair), json.dumps(terms), json.dumps(triangle), f["freedom"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("references", nargs="?", type=pathlib.Path,
                        default=HERE.parents[2] / "shared" / "reference")
    parser.add_argument("--output", type=pathlib.Path, default=HERE / "risk.csv")
    parser.add_argument("--sql", action="store_true", help="print rows for table risk_function")
    arguments = parser.parse_args()
    drivers, stratum = read(arguments.references / "nass_cds" / "frontal_car_crashes.csv")
    fits = [(model, level, fit(drivers, stratum, terms, level))
            for model, terms in MODELS.items() for level in LEVELS]
    if arguments.sql:
        for model, level, f in fits:
            print(sql_row(model, level, f))
        return
    width = max(len(f["terms"]) for _, _, f in fits)
    with open(arguments.output, "w", newline="", encoding="utf-8") as file:
        file.write(f"# {SOURCE}; do not edit. Terms of km/h; covariance: lower triangle.\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["model", "level", "drivers", "injured", "freedom", "term", "coefficient",
                         "share"] + [f"cov_{k}" for k in range(width)])
        for model, level, f in fits:
            for i, term in enumerate(f["terms"]):
                share = f["shares"][i]
                row = f["covariance"][i][:i + 1]
                writer.writerow([model, level, f["drivers"], f["injured"], f["freedom"], term,
                                 digits(f["coefficients"][i]),
                                 "" if share is None else "%.4f" % share]
                                + [digits(v) for v in row] + [""] * (width - len(row)))


if __name__ == "__main__":
    main()
