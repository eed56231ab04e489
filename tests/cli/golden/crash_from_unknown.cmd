$crashpulse crash --from $db --crash 5
