"$crashpulse" report "$db" --output no_such_folder/x.html
