"$crashpulse" plan --help
