"$crashpulse" crash
