printf "# name: two\nweight,crash_type,delta_v_kmh\n1,front-front,20\n2,head-on,30\n" | "$crashpulse" compare "$db" --no-store --field /dev/stdin
