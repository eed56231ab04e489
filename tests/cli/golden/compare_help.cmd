"$crashpulse" compare --help
