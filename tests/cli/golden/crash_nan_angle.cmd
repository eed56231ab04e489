"$crashpulse" crash car.yaml --speed 56 --angle nan
