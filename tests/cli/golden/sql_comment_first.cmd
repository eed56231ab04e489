"$crashpulse" sql "$db" -f csv "-- a comment before the query
SELECT count(*) AS variants FROM variant" --quiet
