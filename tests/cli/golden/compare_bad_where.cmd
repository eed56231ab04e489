"$crashpulse" compare "$db" --no-store --where "closing_speed_m_s >"
