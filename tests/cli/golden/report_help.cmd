"$crashpulse" report --help
