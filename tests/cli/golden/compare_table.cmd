"$crashpulse" compare "$db"
