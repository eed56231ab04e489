"$crashpulse" crash car.yaml --speed 56 --offset 20000
