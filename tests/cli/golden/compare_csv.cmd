"$crashpulse" compare "$db" --no-store --format csv | awk -F, 'NR == 1 { print } NR > 1 { printf "%s,%s,%s,%s,%s,%.6g,%s\n", $1, $2, $3, $4, $5, $6, $9 }'
