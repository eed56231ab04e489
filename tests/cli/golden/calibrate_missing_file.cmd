"$crashpulse" calibrate nowhere.yaml
