"$crashpulse" run
