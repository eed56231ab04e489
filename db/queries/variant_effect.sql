-- SPDX-License-Identifier: GPL-3.0-or-later
-- Does a variant shift the whole distribution of OLC? Every treatment against the baseline over the
-- frontally struck vehicles: medians, Cliff's delta (below 0: the treatment is milder) and the
-- largest distance of the two distribution functions. No test and no interval: `crashpulse compare`
-- has them, with crashes of one replication kept together. Needs the SQL extension.
WITH vehicle AS (
    SELECT variant, variant_id, olc_g, censored FROM frontal_vehicle
    WHERE olc_status <> 'simulation_failed'
)
SELECT t.name AS treatment, sum(x.variant_id = b.id) AS baseline_vehicles,
       sum(x.variant_id = t.id) AS treatment_vehicles,
       round(median(iif(x.variant_id = b.id, olc_g, NULL), x.variant_id = b.id AND censored), 2)
           AS baseline_median_g,
       round(median(iif(x.variant_id = t.id, olc_g, NULL), x.variant_id = t.id AND censored), 2)
           AS treatment_median_g,
       round(cliffs_delta(olc_g, x.variant_id = t.id, censored), 3) AS cliffs_delta,
       round(ks_distance(olc_g, x.variant_id = t.id, censored), 3) AS ks_distance
FROM variant AS t JOIN variant AS b ON b.is_baseline = 1 AND t.is_baseline = 0
JOIN vehicle AS x ON x.variant_id IN (b.id, t.id)
GROUP BY t.id
ORDER BY t.number;
