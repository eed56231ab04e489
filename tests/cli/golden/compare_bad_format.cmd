"$crashpulse" compare "$db" --format xml
