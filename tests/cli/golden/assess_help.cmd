"$crashpulse" assess --help
