"$crashpulse" pulse "$db"
