"$crashpulse" status "$db"
