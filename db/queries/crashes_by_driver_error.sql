-- SPDX-License-Identifier: GPL-3.0-or-later
-- Which driver errors led to the crashes? Crashes by the errors that caused them, all of a crash in one
-- row: "failed_to_see (a)" is an error of the driver of car a. none: no driver erred; not_known: a crash
-- of an earlier version or of files. Definition of a cause: db/schema/012_cause_and_place.sql.
WITH cause AS (
    SELECT crash_id, group_concat(what, ' + ') AS causes
    FROM (SELECT crash_id, driver_error || ' (' || role || ')' AS what FROM crash_cause
          ORDER BY crash_id, role, number)
    GROUP BY crash_id
), known AS (
    SELECT crash_id, count(error_count) = 2 AS is_known FROM crash_vehicle GROUP BY crash_id
)
SELECT c.scenario, c.variant,
       CASE WHEN k.is_known = 0 THEN 'not_known' ELSE coalesce(x.causes, 'none') END AS causes,
       count(*) AS crashes, sum(c.frontal) AS frontal_crashes,
       round(3.6 * avg(c.closing_speed_m_s), 1) AS closing_speed_mean_km_h
FROM crash_list AS c
JOIN known AS k ON k.crash_id = c.id
LEFT JOIN cause AS x ON x.crash_id = c.id
GROUP BY 1, 2, 3
ORDER BY 1, 2, crashes DESC, causes;
