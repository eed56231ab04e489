"$crashpulse" pulse --help
