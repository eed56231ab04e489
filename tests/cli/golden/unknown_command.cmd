"$crashpulse" bogus
