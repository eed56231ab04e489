-- SPDX-License-Identifier: GPL-3.0-or-later
-- Whose error was it, and who pays? Vehicles of crashes by whether a driver error was active on them,
-- how often they are struck on the front, and their mean delta-v.
SELECT s.name AS scenario, v.name AS variant, x.at_fault, count(*) AS vehicles,
       sum(x.frontal) AS struck_on_front, sum(x.contact_side IN ('left', 'right')) AS struck_on_side,
       round(3.6 * avg(x.speed_m_s), 1) AS speed_mean_km_h,
       round(3.6 * avg(x.delta_v_m_s), 1) AS delta_v_mean_km_h
FROM crash_vehicle AS x
JOIN scenario AS s ON s.id = x.scenario_id
JOIN variant AS v ON v.id = x.variant_id
GROUP BY s.id, v.id, x.at_fault
ORDER BY s.number, v.number, x.at_fault;
