"$crashpulse" run study.yaml
