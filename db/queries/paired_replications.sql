-- SPDX-License-Identifier: GPL-3.0-or-later
-- Seed by seed: frontal crashes of every treatment, and the mean OLC of their frontally struck
-- vehicles, beside the baseline's in the replication with the same scenario and number. In the paired
-- design both ran the same demand and seed. A left-censored vehicle counts as 0 g, below which none
-- is; without a simulated vehicle the mean is NULL.
WITH counted AS MATERIALIZED ( -- once, with an index of its own for the join below
    SELECT * FROM replication_crashes
), severity AS MATERIALIZED (
    SELECT replication_id, avg(CASE WHEN censored THEN 0.0 ELSE olc_g END) AS mean_olc_g
    FROM frontal_vehicle
    WHERE olc_status <> 'simulation_failed'
    GROUP BY replication_id
)
SELECT b.scenario, b.replication, b.seed, t.variant AS treatment,
       b.frontal_crashes AS baseline_crashes, t.frontal_crashes AS treatment_crashes,
       t.frontal_crashes - b.frontal_crashes AS difference,
       round(bs.mean_olc_g, 1) AS baseline_mean_olc_g, round(ts.mean_olc_g, 1) AS treatment_mean_olc_g
FROM counted AS b
JOIN variant AS v ON v.id = b.variant_id AND v.is_baseline = 1
JOIN counted AS t ON t.scenario_id = b.scenario_id AND t.replication = b.replication
                             AND t.variant_id <> b.variant_id
LEFT JOIN severity AS bs ON bs.replication_id = b.replication_id
LEFT JOIN severity AS ts ON ts.replication_id = t.replication_id
ORDER BY b.scenario, t.variant, b.replication;
