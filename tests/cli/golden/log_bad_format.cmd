"$crashpulse" compare no_such.db --log-format=xml
