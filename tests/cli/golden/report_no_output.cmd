"$crashpulse" report "$db"
