#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# reports/make_picture.sh [DATABASE]: reports/example/report.png, the top of the report of the demo's database, by
# chromium; without DATABASE the demo is run first, a minute or two. The programs must stand in build/.
set -eu
cd "$(dirname "$0")/.."
db=${1:-build/picture.db}
[ $# -gt 0 ] || build/crashpulse run build/sumo_scenarios/demo/study.yaml --db "$db"
build/crashpulse report "$db" --output build/picture.html
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=1100,1000 \
    --virtual-time-budget=5000 --screenshot="$PWD/reports/example/report.png" "file://$PWD/build/picture.html"
