echo "SELECT count(*) AS n FROM variant;" | "$crashpulse" sql "$db"
