-- SPDX-License-Identifier: GPL-3.0-or-later
-- Seed by seed: frontal crashes of every treatment beside the baseline's in the replication with
-- the same scenario and number. In the paired design both ran the same demand and seed.
SELECT b.scenario, b.replication, b.seed, t.variant AS treatment,
       b.frontal_crashes AS baseline_crashes, t.frontal_crashes AS treatment_crashes,
       t.frontal_crashes - b.frontal_crashes AS difference
FROM replication_crashes AS b
JOIN variant AS v ON v.id = b.variant_id AND v.is_baseline = 1
JOIN replication_crashes AS t ON t.scenario_id = b.scenario_id AND t.replication = b.replication
                             AND t.variant_id <> b.variant_id
ORDER BY b.scenario, t.variant, b.replication;
