"$crashpulse" export "$db" --as geojson --output x.json
