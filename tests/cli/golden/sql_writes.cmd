"$crashpulse" sql "$db" "DELETE FROM crash"
