"$crashpulse" pulse "$db" --crash 12
