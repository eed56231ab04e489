"$crashpulse" crash car.yaml --speed 50 --seed 3
