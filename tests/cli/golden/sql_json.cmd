"$crashpulse" sql "$db" --format json "SELECT 0.1 AS x, NULL AS n, 3 AS i, 'a\"b' AS t"
