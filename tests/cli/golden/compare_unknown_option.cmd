"$crashpulse" compare "$db" --bogus
