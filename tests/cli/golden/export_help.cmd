"$crashpulse" export --help
