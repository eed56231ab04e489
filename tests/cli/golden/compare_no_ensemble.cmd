"$crashpulse" compare "$db" --no-store --model-uncertainty
