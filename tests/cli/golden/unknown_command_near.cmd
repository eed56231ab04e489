"$crashpulse" compear "$db"
