"$crashpulse" plot "$db" pie --output x.svg
