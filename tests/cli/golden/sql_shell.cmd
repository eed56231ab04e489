echo "SELECT count(*) AS n FROM variant;" | LD_PRELOAD="$CRASHPULSE_PRELOAD" ASAN_OPTIONS=detect_leaks=0 "$crashpulse" sql "$db"
