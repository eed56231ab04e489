$crashpulse check none.db
