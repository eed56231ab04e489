"$crashpulse" compare "$db" --no-store --by crash_type --where "closing_speed_m_s > 12" --format csv 2>/dev/null | grep -E ',(frontal_crashes|frontal_vehicles|olc_n),' | sort
