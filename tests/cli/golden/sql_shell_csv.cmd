echo "SELECT 'a,b' AS t, 3 AS i;" | LD_PRELOAD="$CRASHPULSE_PRELOAD" ASAN_OPTIONS=detect_leaks=0 "$crashpulse" sql "$db" --format csv
