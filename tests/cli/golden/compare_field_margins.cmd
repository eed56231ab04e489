"$crashpulse" compare "$db" --no-store --field nass --field-margins crash_type,pdof
