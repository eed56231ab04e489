"$crashpulse" run --help
