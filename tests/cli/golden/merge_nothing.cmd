"$crashpulse" merge out.db
