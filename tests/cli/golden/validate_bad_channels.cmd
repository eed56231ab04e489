"$crashpulse" validate x.yaml --pulse p --channels 93,x
