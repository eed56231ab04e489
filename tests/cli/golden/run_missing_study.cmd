"$crashpulse" run no_such_study.yaml --db no_such.db; code=$?; [ -e no_such.db ] && echo "half-written database"; exit $code
