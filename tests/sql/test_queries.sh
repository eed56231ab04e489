#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_queries.sh DATABASE COUNTERFACTUAL EXTENSION FOLDER: every file of db/queries runs by the stock sqlite3 with
# the extension loaded, opens with a comment, writes nothing, gives exactly the rows recorded in
# golden/, and agrees with what is counted another way. What was seen is left in FOLDER.
set -eu
db=$1
counterfactual=$2
extension=$3
seen=$4
golden=$(dirname "$0")/golden
mkdir -p "$seen"
# The small study with pulses in it.
cp "$db" "$seen/study.db"
db=$seen/study.db
for name in small_study_pulses small_members small_evidence; do
    sqlite3 -batch -bail "$db" <"$(dirname "$0")/$name.sql"
done
# With sanitizers their runtime has to be there before the stock shell's first allocation.
shell() {
    LD_PRELOAD="${CRASHPULSE_PRELOAD:-}" ASAN_OPTIONS=detect_leaks=0 \
        sqlite3 -readonly -batch -bail -cmd ".load '${extension%.so}'" "$db"
}
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

study=$db
for file in "$queries"/*.sql; do
    name=$(basename "$file")
    # Pairs are only in a counterfactual study.
    db=$study
    [ "$name" != counterfactual_pairs.sql ] || db=$counterfactual
    sed -n 2p "$file" | grep -q '^-- [A-Z]' || fail "$name: the second line says what it asks"
    name=${name%.sql}
    shell <"$file" >"$seen/$name.out" || fail "$name: does not run"
    [ -s "$seen/$name.out" ] || fail "$name: no rows"
    diff -u "$golden/$name.out" "$seen/$name.out" >&2 || fail "$name: other rows"
    # Queries that do not say so need no extension.
    grep -q 'Needs the SQL extension' "$file" ||
        sqlite3 -readonly -batch -bail "$db" <"$file" | diff -q - "$seen/$name.out" >/dev/null ||
        fail "$name: needs the extension and does not say so"
done
db=$study
[ "$(ls "$queries"/*.sql | wc -l)" -ge 20 ] || fail "fewer than twenty queries"

one() {
    sqlite3 -readonly -batch "$db" "$1"
}

expect "crashes of exposure_and_rates" "$(sum 6 exposure_and_rates)" "$(one 'SELECT count(*) FROM crash')"
expect "crashes of configuration_map" "$(sum 5 configuration_map)" \
    "$(one "SELECT count(*) FROM crash WHERE crash_type LIKE 'front-%'")"
expect "crashes of crash_configurations" "$(sum 4 crash_configurations)" \
    "$(one 'SELECT count(*) FROM crash')"
expect "crashes above 15 g of crashes_above_severity" \
    "$(sqlite3 -readonly "$db" <"$queries/crashes_above_severity.sql" | awk -F'|' '$2 == 15 { print $3 }' | paste -sd' ')" \
    "$(one "SELECT group_concat(n, ' ') FROM (SELECT count(DISTINCT crash_id) AS n FROM frontal_vehicle WHERE olc_g > 15 GROUP BY variant_id ORDER BY variant_id)")"
expect "vehicles of validity" "$(sum 4 validity)" \
    "$(one 'SELECT count(*) FROM crash_vehicle WHERE frontal = 1')"
expect "vehicles of validity_classes" "$(sum 3 validity_classes)" \
    "$(sqlite3 -readonly "$db" 'SELECT count(*) FROM crash_vehicle WHERE frontal = 1')"
expect "vehicles of struck_vehicles" "$(sum 4 struck_vehicles)" \
    "$(sqlite3 -readonly "$db" 'SELECT count(*) FROM crash_vehicle WHERE frontal = 0 AND delta_v_m_s IS NOT NULL')"
expect "vehicles of vehicle_classes" "$(sum 3 vehicle_classes)" \
    "$(sqlite3 -readonly "$db" 'SELECT count(*) FROM crash_vehicle')"
expect "vehicles with one reason of validity_reasons" "$(sum 4 validity_reasons)" \
    "$(one "SELECT count(*) FROM crash_vehicle WHERE frontal = 1 AND validity <> 'inside' AND instr(validity, ',') = 0")"
expect "treatment crashes of paired_replications" "$(sum 6 paired_replications)" \
    "$(one "SELECT frontal_crashes FROM olc_by_variant WHERE variant = 'aeb'")"
# Seeds find their partners by an index: twice as many pairs take twice as long, not four times.
expect "partners of paired_replications are looked for" \
    "$({ echo 'EXPLAIN QUERY PLAN'; cat "$queries/paired_replications.sql"; } | sqlite3 -readonly -batch "$db" | grep -Ec 'SEARCH (t|bs|ts) USING .*INDEX')" 3
expect "pairs of counterfactual_pairs" "$(wc -l <"$seen/counterfactual_pairs.out" | tr -d ' ')" \
    "$(sqlite3 -readonly "$counterfactual" "SELECT count(*) FROM counterfactual AS x JOIN crash AS c ON c.id = x.crash_id
        WHERE x.outcome <> 'invalid' AND c.crash_type LIKE 'front-%' AND x.outcome_olc <> 'no_olc'")"
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
# The distribution's own median, by the extension and in plain SQL.
expect "median of variant_effect" \
    "$(shell <"$queries/variant_effect.sql" | cut -d'|' -f4,5)" \
    "$(one "SELECT group_concat(round(olc_median_g, 2), '|') FROM olc_by_variant")"
expect "crashes of crash_map" "$(sum 4 crash_map)" "$(one 'SELECT count(*) FROM crash')"
expect "crashes of crash_types" "$(sum 3 crash_types)" "$(one 'SELECT count(*) FROM crash')"
expect "vehicles of at_fault" "$(sum 4 at_fault)" "$(one 'SELECT count(*) FROM crash_vehicle')"
expect "crashes of both_vehicles" "$(sum 4 both_vehicles)" \
    "$(one "SELECT count(*) FROM crash WHERE crash_type = 'front-front'")"
expect "crashes of crashes_by_driver_error" "$(sum 4 crashes_by_driver_error)" "$(one 'SELECT count(*) FROM crash')"
expect "crashes without a known cause of crashes_by_driver_error" \
    "$(sqlite3 -readonly "$db" <"$queries/crashes_by_driver_error.sql" | awk -F'|' '$3 == "not_known" { s += $4 } END { print s }')" \
    "$(one 'SELECT count(*) FROM crash_vehicle WHERE role = '"'a'"' AND error_count IS NULL')"
expect "crashes of crashes_by_place" "$(sum 5 crashes_by_place)" "$(one 'SELECT count(*) FROM crash')"
expect "cars of function_at_contact" "$(sum 5 function_at_contact)" \
    "$(one "SELECT count(*) FROM crash_function AS f JOIN crash AS c ON c.id = f.crash_id WHERE c.crash_type LIKE 'front-%'")"
expect "cars of crash_partners" "$(sum 6 crash_partners)" \
    "$(one 'SELECT count(*) FROM crash_vehicle WHERE frontal = 1 AND mass_kg IS NOT NULL')"
expect "vehicles of struck_sides" "$(sum 5 struck_sides)" \
    "$(one 'SELECT count(*) FROM crash_vehicle WHERE frontal = 0 AND intrusion_m IS NOT NULL')"
expect "last rows of convergence" \
    "$(shell <"$queries/convergence.sql" | awk -F'|' '$2 == 7 { print $3 "|" $5 }' | paste -sd' ')" \
    "$(one "SELECT group_concat(frontal_crashes || '|' || round(olc_median_g, 2), ' ') FROM
            (SELECT * FROM olc_by_variant ORDER BY variant)")"
[ "$failures" -eq 0 ]
