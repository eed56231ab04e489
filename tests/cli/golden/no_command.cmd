"$crashpulse"
