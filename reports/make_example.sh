#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# reports/make_example.sh [DATABASE]: the example under reports/example/, from the database of the
# flagship study; without DATABASE the study is run first, a few minutes. The programs must stand in build/.
set -eu
cd "$(dirname "$0")/.."
db=${1:-build/example.db}
[ $# -gt 0 ] || build/crashpulse run build/sumo_scenarios/adas_comparison/study.yaml --db "$db"
mkdir -p reports/example
build/crashpulse compare "$db" --no-store >reports/example/compare.txt
for kind in rates outcomes difference severity benefit; do
    build/crashpulse plot "$db" "$kind" --output "reports/example/$kind.svg"
done
build/crashpulse sql "$db" "SELECT s.name AS study, s.hash AS study_hash, r.crashpulse_version,
    r.sumo_version, count(*) AS replications FROM study AS s CROSS JOIN replication AS r
    WHERE r.status = 'done' GROUP BY 1, 2, 3, 4" >reports/example/made_from.txt
