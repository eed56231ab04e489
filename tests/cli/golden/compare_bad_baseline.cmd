"$crashpulse" compare "$db" --baseline esp
