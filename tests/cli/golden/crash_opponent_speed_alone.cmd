"$crashpulse" crash car.yaml --speed 56 --opponent-speed 30
