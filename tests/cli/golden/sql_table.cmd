"$crashpulse" sql "$db" "SELECT variant, crashes, olc_median_g FROM olc_by_variant"
