-- SPDX-License-Identifier: GPL-3.0-or-later
-- How far can the severities be trusted? Frontally struck vehicles of each variant by what lies
-- outside the range their vehicle model was validated in ('inside': nothing). No mean where some are
-- left-censored: without them it would rise as crashes get milder.
SELECT variant, crash_type, validity, count(*) AS vehicles, sum(censored) AS censored,
       CASE WHEN sum(censored) = 0 THEN round(avg(olc_g), 2) END AS olc_mean_g
FROM frontal_vehicle
GROUP BY variant, crash_type, validity
ORDER BY variant, crash_type, vehicles DESC;
