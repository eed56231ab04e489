#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make scorecard.csv and scorecard.md from a run of the suite; standard library only.

    cmake --build build --target scorecard
    python3 db/validation/scorecard.py build/crashpulse [--output FOLDER] [--vehicle NAME|FILE ...]

Numbers have four significant digits, so that the same model gives the same files everywhere."""
import argparse
import json
import pathlib
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
COLUMNS = ("class", "title", "vehicle", "quantity", "label", "unit", "cases", "reference", "model", "bias",
           "mean_abs", "max_abs", "error_unit", "inside_1", "bar", "result", "note")


def text(value):
    return "" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def quoted(field):
    return '"' + field.replace('"', '""') + '"' if any(c in field for c in ',"\n') else field


def as_csv(rows):
    lines = [",".join(COLUMNS)]
    lines += [",".join(quoted(text(row[column])) for column in COLUMNS) for row in rows]
    return "\n".join(lines) + "\n"


def tally(rows):
    """Bars kept of bars judged, a vehicle."""
    counts = {}
    for row in rows:
        kept, judged = counts.get(row["vehicle"], (0, 0))
        counts[row["vehicle"]] = (kept + (row["result"] == "kept"),
                                  judged + (row["result"] in ("kept", "missed")))
    return counts


def as_markdown(rows):
    lines = ["# Scorecard: the vehicle models beside real crash tests", "",
             "Made by `cmake --build build --target scorecard`; do not edit. What is compared, where the",
             "tests come from and what the bars are: `README.md` and `suite.yaml`. Every case by itself:",
             "`crashpulse validate --suite db/validation/suite.yaml --cases`.", "",
             "| vehicle | bars kept |", "|---|---|"]
    lines += [f"| {vehicle} | {kept} of {judged} |" for vehicle, (kept, judged) in tally(rows).items()]
    head = ["vehicle", "quantity", "cases", "test", "model", "bias", "mean abs.", "inside", "bar",
            "result", "note"]
    title = None
    for row in rows:
        if row["title"] != title:
            title = row["title"]
            lines += ["", f"## {title} (`{row['class']}`)", "", "| " + " | ".join(head) + " |",
                      "|" + "---|" * len(head)]
        unit, error = row["unit"].replace("1", ""), row["error_unit"].replace("1", "")
        inside = "" if row["inside_1"] is None else f"{100 * row['inside_1']:.0f} %"
        figures = [" ".join((text(row[key]), mark)).strip() if row[key] is not None else ""
                   for key, mark in (("reference", unit), ("model", unit), ("bias", error),
                                     ("mean_abs", error))]
        lines.append("| " + " | ".join([row["vehicle"], row["quantity"], str(row["cases"]), *figures,
                                        inside, row["bar"], row["result"], row["note"]]) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description="scorecard of the vehicle models")
    parser.add_argument("crashpulse", help="the program")
    parser.add_argument("--output", type=pathlib.Path, default=HERE)
    parser.add_argument("--vehicle", action="append", default=[], help="instead of the suite's")
    arguments = parser.parse_args()
    command = [arguments.crashpulse, "validate", "--suite", str(HERE / "suite.yaml"), "--format", "json"]
    for vehicle in arguments.vehicle:
        command += ["--vehicle", vehicle]
    rows = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    (arguments.output / "scorecard.csv").write_text(as_csv(rows), encoding="utf-8")
    (arguments.output / "scorecard.md").write_text(as_markdown(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
