$crashpulse crash --from $db --crash 5 --speed 50
