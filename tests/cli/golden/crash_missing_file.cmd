"$crashpulse" crash no_such_car.yaml --speed 56
