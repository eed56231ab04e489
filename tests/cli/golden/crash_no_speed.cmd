"$crashpulse" crash car.yaml
