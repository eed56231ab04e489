"$crashpulse" crash honda_acord_2014 --speed 50
