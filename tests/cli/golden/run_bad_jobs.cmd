"$crashpulse" run study.yaml --db x.db --jobs 0
