copy=compare_stored.db
rm -f "$copy" "$copy-wal" "$copy-shm"
sqlite3 -readonly "$db" "VACUUM INTO '$copy'"
"$crashpulse" compare "$copy" >/dev/null 2>&1
"$crashpulse" compare "$copy" >/dev/null 2>&1
"$crashpulse" compare "$copy" --scenario left_turn >/dev/null 2>&1
"$crashpulse" sql "$copy" "SELECT c.scenario, f.variant, f.quantity, f.value = v.frontal_crashes AS as_in_view, count(*) AS rows FROM comparison AS c JOIN comparison_figure AS f ON f.comparison_id = c.id JOIN crash_rate_by_variant AS v USING (variant) WHERE f.quantity = 'frontal_crashes' GROUP BY c.scenario, f.variant"
"$crashpulse" sql "$copy" "SELECT interval, low IS NULL AS open, count(*) > 0 AS there FROM comparison_figure WHERE quantity IN ('rate_ratio', 'rate_ratio_widened') GROUP BY 1, 2"
