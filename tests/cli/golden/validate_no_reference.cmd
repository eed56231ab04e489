"$crashpulse" validate x.yaml
