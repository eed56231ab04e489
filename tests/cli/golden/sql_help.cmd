"$crashpulse" sql --help
