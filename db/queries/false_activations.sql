-- SPDX-License-Identifier: GPL-3.0-or-later
-- How often does a function warn or intervene in an hour on the road? Where a scenario has no driver errors
-- (0 in the third column), nobody is in danger, and each of these is for nothing. Brakings that
-- false_activations_per_h asks for are among the activations.
SELECT s.name AS scenario, v.name AS variant, json_array_length(s.driver_errors) AS driver_errors,
       j.key AS what, sum(j.value) AS total, round(sum(r.vehicle_h), 1) AS vehicle_h,
       round(sum(j.value) / sum(r.vehicle_h), 2) AS per_vehicle_h,
       round(100.0 * sum(j.value) / sum(r.vehicle_km), 2) AS per_100_km,
       (SELECT count(*) FROM crash AS c JOIN replication AS x ON x.id = c.replication_id
        WHERE x.scenario_id = s.id AND x.variant_id = v.id) AS crashes
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
JOIN json_each(r.counters) AS j
WHERE r.status = 'done' AND j.key IN ('aeb.activations', 'fcw.warnings', 'elk.interventions')
GROUP BY s.id, v.id, j.key
ORDER BY s.number, v.number, j.key;
