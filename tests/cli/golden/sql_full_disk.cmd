[ -w /dev/full ] || exit 1; "$crashpulse" sql "$db" "SELECT 1" > /dev/full
