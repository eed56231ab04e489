"$crashpulse" run study.yaml --jobz 2 --db x.db
