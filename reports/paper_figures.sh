#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# reports/paper_figures.sh [FOLDER]: the surrogate paper's figures 7, 8 and 12 drawn anew for our model
# of its car, as pages, into FOLDER (default build/paper_figures), each with the command that draws it. The program stands in build/, or is named
# by CRASHPULSE.
# The curves of the paper's finite-element model are not public: where the paper lays its surrogate
# over them, these pages lay two parameter sets over each other, the shipped one and the mid-size car
# fitted to the middle of real tests.
set -eu
cd "$(dirname "$0")/.."
folder=${1:-build/paper_figures}
crashpulse=${CRASHPULSE:-build/crashpulse}
accord=db/vehicles/honda_accord_2014.yaml
second=db/vehicles/mid_size.yaml
mkdir -p "$folder"

# Configurations of smallest and largest error in OLC: "speed offset angle".
ranked=$("$crashpulse" validate "$accord" --reference db/reference/olc_accord_2014.csv --format csv |
    awk -F, 'NR > 1 { print ($6 < 0 ? -$6 : $6), $1, $2, $3 }' | sort -g)
best=$(echo "$ranked" | head -n 1 | cut -d ' ' -f 2-)
worst=$(echo "$ranked" | tail -n 1 | cut -d ' ' -f 2-)

# crash_page "SPEED OFFSET ANGLE" FILE OPTIONS...
crash_page() {
    set -f
    # shellcheck disable=SC2086
    set -- $1 "$@"
    speed=$1 offset=$2 angle=$3 file=$folder/$5
    shift 5
    set -- crash "$accord" --speed "$speed" --offset "$offset" --angle "$angle" "$@" --animate "$file"
    echo "crashpulse $*"
    "$crashpulse" "$@" >/dev/null
}

crash_page "$best" figure_7_best.html --overlay-vehicle "$second"
crash_page "$worst" figure_7_worst.html --overlay-vehicle "$second"
# The same from above at three moments: #t=0, #t=100 and #t=200 behind the page's address.
crash_page "$worst" figure_8.html --overlay-vehicle "$second" --duration 200
crash_page "56 0 0" figure_12.html --against "$accord" --overlay-against barrier
