"$crashpulse" compare "$db" --no-store --field nowhere.csv
