-- SPDX-License-Identifier: GPL-3.0-or-later
-- Which crashes brought further ones about? First crashes into whose standing cars others drove
-- (after_crash.stay_s in the study file), how many, how soon, and how fast the hardest was.
SELECT scenario, variant, first_crash_id,
       first_crash_type, round(first_time_s, 1) AS first_s, count(DISTINCT s.crash_id) AS secondary,
       max(generation) AS generations, round(min(after_s), 1) AS soonest_after_s,
       round(max(closing_speed_m_s), 1) AS closing_speed_max_m_s,
       count(DISTINCT cars.sumo_id) AS cars
FROM secondary_crash AS s
JOIN (SELECT crash_id, sumo_id FROM crash_vehicle) AS cars
    ON cars.crash_id IN (s.crash_id, s.first_crash_id)
GROUP BY first_crash_id
ORDER BY secondary DESC, first_crash_id;
