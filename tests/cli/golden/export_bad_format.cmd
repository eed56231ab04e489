"$crashpulse" export "$db" --as xlsx --output x
