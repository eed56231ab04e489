-- SPDX-License-Identifier: GPL-3.0-or-later
-- Where does it crash? Crashes in squares of 10 m of the network's plane, given by their middle, the
-- worst places first, with the highest OLC there. For a map of another grain change the two 10.
SELECT scenario, 10.0 * round(x_m / 10.0) AS x_m, 10.0 * round(y_m / 10.0) AS y_m,
       count(*) AS crashes, sum(frontal) AS frontal_crashes,
       round((SELECT max(v.olc_g) FROM crash_vehicle AS v JOIN crash AS c ON c.id = v.crash_id
              JOIN replication AS r ON r.id = c.replication_id
              JOIN scenario AS s ON s.id = r.scenario_id
              WHERE s.name = l.scenario AND round(c.x_m / 10.0) = round(l.x_m / 10.0)
                AND round(c.y_m / 10.0) = round(l.y_m / 10.0)), 1) AS olc_max_g
FROM crash_list AS l
GROUP BY scenario, round(l.x_m / 10.0), round(l.y_m / 10.0)
ORDER BY crashes DESC, scenario, x_m, y_m;
