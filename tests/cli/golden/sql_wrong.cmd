"$crashpulse" sql "$db" "SELEC 1"
