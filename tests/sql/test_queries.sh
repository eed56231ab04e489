#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_queries.sh DATABASE: every file of db/queries runs by plain sqlite3, opens with a comment,
# gives rows, writes nothing, and agrees with what is counted another way.
set -eu
db=$1
queries=$(dirname "$0")/../../db/queries
failures=0

fail() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

# expect WHAT FOUND EXPECTED
expect() {
    [ "$2" = "$3" ] || fail "$1: found '$2', expected '$3'"
}

sum() {
    # sum NUMBER_OF_COLUMN QUERY: over the rows of db/queries/QUERY.sql
    sqlite3 -readonly -batch -bail "$db" <"$queries/$2.sql" | awk -F'|' -v c="$1" '{ s += $c } END { print s + 0 }'
}

for file in "$queries"/*.sql; do
    name=$(basename "$file")
    sed -n 2p "$file" | grep -q '^-- [A-Z]' || fail "$name: the second line says what it asks"
    rows=$(sqlite3 -readonly -batch -bail "$db" <"$file" | wc -l) || fail "$name: does not run"
    [ "$rows" -gt 0 ] || fail "$name: no rows"
done

one() {
    sqlite3 -readonly -batch "$db" "$1"
}

expect "crashes of exposure_and_rates" "$(sum 6 exposure_and_rates)" "$(one 'SELECT count(*) FROM crash')"
expect "crashes of configuration_map" "$(sum 5 configuration_map)" \
    "$(one "SELECT count(*) FROM crash WHERE crash_type LIKE 'front-%'")"
expect "crashes of crash_configurations" "$(sum 4 crash_configurations)" \
    "$(one 'SELECT count(*) FROM crash')"
expect "vehicles of validity" "$(sum 4 validity)" \
    "$(one 'SELECT count(*) FROM crash_vehicle WHERE frontal = 1')"
expect "treatment crashes of paired_replications" "$(sum 6 paired_replications)" \
    "$(one "SELECT frontal_crashes FROM olc_by_variant WHERE variant = 'aeb'")"
expect "highest OLC of worst_crashes" \
    "$(sqlite3 -readonly "$db" <"$queries/worst_crashes.sql" | head -1 | cut -d'|' -f7)" \
    "$(one 'SELECT round(max(olc_g), 1) FROM crash_vehicle')"
expect "last share of olc_distribution" \
    "$(sqlite3 -readonly "$db" <"$queries/olc_distribution.sql" | tail -1 | cut -d'|' -f3)" "1.0"

# The distribution starts at the censored share, not at 0 and not without them.
expect "first share of aeb" \
    "$(sqlite3 -readonly "$db" <"$queries/olc_distribution.sql" | grep '^aeb' | head -1)" \
    "aeb||$(one "SELECT 1.0 * censored / (frontal_vehicles - simulation_failed) FROM olc_by_variant WHERE variant = 'aeb'")"
# Median of the quantile query (column 7) and of the view.
expect "medians of olc_quantiles" \
    "$(sqlite3 -readonly "$db" <"$queries/olc_quantiles.sql" | awk -F'|' '$2 == "all" { printf "%.9f\n", $7 }')" \
    "$(one "SELECT printf('%.9f', olc_median_g) FROM olc_by_variant")"
[ "$failures" -eq 0 ]
