"$crashpulse" compare "$db" --no-store --field nass | sed -n "/^baseline beside/,/^of 8.6 km/p;/^  vehicles struck on the front  *161 /,/^  OLC, g, 90/p;/^  rate ratio of frontal/,/^  OLC, g, diff/p"
