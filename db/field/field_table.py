#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the field table that ships, nass_cds.csv.gz, from the NASS-CDS extract.

    python3 db/field/field_table.py [REFERENCES] [--output FILE]

REFERENCES (default ../shared/reference beside the project) holds nass_cds/frontal_car_crashes.csv.
One row is a front-damaged vehicle of a crash of two light vehicles with known delta-v, with its
national inflation weight; rows of weight 0 are left out. FILE ends with .gz or not. The columns, and
how a table of another source has to look: README.md in this folder. Same input, same bytes."""
import argparse
import csv
import gzip
import io
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
HEADER = """\
# name: NASS-CDS 2000-2015
# source: US DOT NHTSA, National Automotive Sampling System - Crashworthiness Data System, public-use
#   files, case years 2000 to 2015 without 2005; a US Government work, public domain
# rows: front-damaged light vehicles of crashes of two light vehicles, delta-v known, worst impact
#   that with the other vehicle; tow-away sample: milder crashes are missing
# delta_v: WinSMASH, without rebound
# bias: against event data recorders WinSMASH's delta-v is 23 % low on average (1 % in frontals once
#   restitution is allowed for: Niehoff and Gabler, PMC3217484), in NASS 19 % with a standard deviation
#   of 8.6 km/h over 228 frontals (Funk et al. 2008)
# overlap: width of direct damage over the undeformed width of the front end, at most 1
# pdof: of delta-v, 0 head-on, positive from the right
# made by: db/field/field_table.py
"""
COLUMNS = ("weight", "stratum", "cluster", "crash_type", "delta_v_kmh", "pdof_deg", "overlap_1")
CRASH_TYPE = {"FF": "front-front", "FS": "front-side", "FR": "front-rear"}


def row_of(source):
    """What ships of a row of the extract; None without weight."""
    if float(source["ratwgt"]) <= 0.0:
        return None
    return (source["ratwgt"], source["psustrat"], source["id"].split("-")[1],
            CRASH_TYPE.get(source["crash_type"], ""), source["dv_total_kmh"],
            source["pdof_dv_deg"], source["overlap"])


def table_of(rows):
    text = io.StringIO()
    text.write(HEADER)
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(row for row in map(row_of, rows) if row)
    return text.getvalue()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("references", nargs="?", type=pathlib.Path,
                        default=HERE.parents[2] / "shared" / "reference")
    parser.add_argument("--output", type=pathlib.Path, default=HERE / "nass_cds.csv.gz")
    arguments = parser.parse_args()
    path = arguments.references / "nass_cds" / "frontal_car_crashes.csv"
    with open(path, newline="", encoding="utf-8") as file:
        content = table_of(csv.DictReader(file)).encode()
    if arguments.output.suffix == ".gz":
        content = gzip.compress(content, compresslevel=9, mtime=0)
    arguments.output.write_bytes(content)


if __name__ == "__main__":
    main()
