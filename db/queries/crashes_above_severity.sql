-- SPDX-License-Identifier: GPL-3.0-or-later
-- How often crashes above an OLC happen: frontal crashes per million vehicle-km of which a frontally
-- struck vehicle exceeds it, for every variant and whole g. at_least are those that a vehicle inside
-- the surrogate's validated range makes certain; at_most also counts every crash with a frontally
-- struck vehicle outside it. A comparison of variants by these needs no conditioning on crashing.
WITH RECURSIVE step (above_olc_g) AS (
    SELECT 0 UNION ALL SELECT above_olc_g + 1 FROM step WHERE above_olc_g < 40
), severity AS (
    SELECT variant_id, crash_id, coalesce(max(olc_g), -1) AS olc_g,
           coalesce(max(olc_g) FILTER (WHERE validity = 'inside'), -1) AS inside_g,
           max(validity <> 'inside' OR olc_status = 'simulation_failed') AS is_open
    FROM crash_vehicle
    WHERE frontal = 1
    GROUP BY variant_id, crash_id
)
SELECT x.variant, step.above_olc_g, coalesce(sum(s.olc_g > above_olc_g), 0) AS crashes,
       coalesce(sum(s.inside_g > above_olc_g), 0) AS at_least,
       coalesce(sum(s.inside_g > above_olc_g OR s.is_open), 0) AS at_most,
       1e6 * coalesce(sum(s.olc_g > above_olc_g), 0) / x.vehicle_km AS per_million_km
FROM crash_rate_by_variant AS x CROSS JOIN step
LEFT JOIN severity AS s ON s.variant_id = x.variant_id
WHERE x.vehicle_km > 0
GROUP BY x.variant_id, step.above_olc_g
ORDER BY x.variant_id, step.above_olc_g;
