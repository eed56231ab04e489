-- SPDX-License-Identifier: GPL-3.0-or-later
-- Where on the network do they crash? Crashes by the junction that car a is in, else by its edge, and
-- whether both cars are in the same one. place and edge are NULL where they are not known (an earlier
-- version, or files without lanes).
WITH both AS (
    SELECT a.crash_id, a.scenario_id, a.variant_id, a.crash_type, a.junction, a.edge, a.lane,
           CASE WHEN a.junction IS NOT NULL THEN 'junction' WHEN a.edge IS NOT NULL THEN 'road' END AS place,
           coalesce(a.junction = b.junction, a.edge = b.edge) AS is_same
    FROM crash_vehicle AS a
    JOIN crash_vehicle AS b ON b.crash_id = a.crash_id AND b.role = 'b'
    WHERE a.role = 'a'
)
SELECT s.name AS scenario, v.name AS variant, x.place, coalesce(x.junction, x.edge) AS name,
       count(*) AS crashes, sum(x.crash_type LIKE 'front-%') AS frontal_crashes,
       count(DISTINCT x.lane) AS lanes, sum(x.is_same) AS both_there
FROM both AS x
JOIN scenario AS s ON s.id = x.scenario_id
JOIN variant AS v ON v.id = x.variant_id
GROUP BY s.id, v.id, x.place, coalesce(x.junction, x.edge)
ORDER BY s.number, v.number, crashes DESC, x.place, coalesce(x.junction, x.edge);
