$crashpulse crash --from $db
