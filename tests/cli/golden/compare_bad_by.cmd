"$crashpulse" compare "$db" --no-store --by "1; DROP TABLE crash"
