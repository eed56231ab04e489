"$crashpulse" crash car.yaml --speed 56kmh
