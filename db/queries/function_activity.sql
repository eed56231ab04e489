-- SPDX-License-Identifier: GPL-3.0-or-later
-- What did drivers and assistance functions do? Every counter of the finished replications (column
-- counters), in total and for each 1000 vehicle-km.
SELECT s.name AS scenario, v.name AS variant, j.key AS counter, sum(j.value) AS total,
       round(1000.0 * sum(j.value) / sum(r.vehicle_km), 3) AS per_1000_km
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
JOIN json_each(r.counters) AS j
WHERE r.status = 'done' AND j.type IN ('integer', 'real')
GROUP BY s.id, v.id, j.key
ORDER BY s.number, v.number, j.key;
