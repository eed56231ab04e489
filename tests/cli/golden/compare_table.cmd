"$crashpulse" compare "$db" --no-store
