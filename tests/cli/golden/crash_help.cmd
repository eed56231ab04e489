"$crashpulse" crash --help
