"$crashpulse" sql "$db" "SELECT id FROM crash WHERE 0"
