"$crashpulse" plan --db x.db
