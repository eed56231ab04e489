"$crashpulse" plot --help
