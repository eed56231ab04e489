"$crashpulse" status none.db
