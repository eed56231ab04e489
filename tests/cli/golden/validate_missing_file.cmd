"$crashpulse" validate nowhere.yaml --reference nowhere.csv
