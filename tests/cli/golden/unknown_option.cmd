"$crashpulse" --bogus
