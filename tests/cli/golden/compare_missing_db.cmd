"$crashpulse" compare no_such.db; code=$?; [ -e no_such.db ] && echo "created"; exit $code
