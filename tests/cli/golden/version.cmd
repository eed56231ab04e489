"$crashpulse" --version | grep -c "^crashpulse [0-9]"
