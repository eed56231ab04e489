"$crashpulse" --help
