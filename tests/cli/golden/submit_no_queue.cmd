"$crashpulse" submit x.yaml --db x.db
