"$crashpulse" crash car.yaml --speed 50 --overlay-against barrier
