-- SPDX-License-Identifier: GPL-3.0-or-later
-- How do crash rate and OLC change with a parameter of a function? One row for every value of every
-- parameter that a variant has, swept ones first (swept = 1); of a sweep over two parameters each row
-- is one combination, named in variant.
SELECT p.base, p.function, p.parameter, p.value, p.swept, p.variant,
       r.frontal_crashes, round(r.frontal_crashes_per_million_km, 1) AS frontal_crashes_per_million_km,
       round(o.olc_median_g, 2) AS olc_median_g, round(o.share_inside_validity, 3) AS share_inside_validity
FROM variant_parameter AS p
JOIN crash_rate_by_variant AS r USING (variant_id)
JOIN olc_by_variant AS o USING (variant_id)
ORDER BY p.swept DESC, p.base, p.function, p.parameter, p.value, p.variant;
