-- SPDX-License-Identifier: GPL-3.0-or-later
-- The distribution function of OLC for every variant: the share of frontally struck vehicles with
-- an OLC up to olc_g. The first row of a variant with left-censored vehicles has olc_g NULL: its
-- share is where the curve starts, above zero.
SELECT variant, olc_g,
       1.0 * count(*) OVER (PARTITION BY variant ORDER BY olc_g NULLS FIRST)
           / count(*) OVER (PARTITION BY variant) AS share
FROM frontal_vehicle
WHERE olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')
ORDER BY variant, olc_g NULLS FIRST;
