"$crashpulse" compare "$db" --no-store --field nass --format csv | grep -E "as_field|by_delta_v_too|never" | grep -v "share_\|NASS" | cut -d, -f1,2,4,5,6
