-- SPDX-License-Identifier: GPL-3.0-or-later
-- Who has it worse? Front-to-front crashes by the models of the two vehicles: mean OLC and delta-v of
-- a and of b, and how often each has the higher OLC.
SELECT v.name AS variant, a.vehicle_model AS model_a, b.vehicle_model AS model_b,
       count(*) AS crashes, round(avg(a.olc_g), 2) AS olc_mean_a_g,
       round(avg(b.olc_g), 2) AS olc_mean_b_g,
       round(3.6 * avg(a.delta_v_m_s), 1) AS delta_v_mean_a_km_h,
       round(3.6 * avg(b.delta_v_m_s), 1) AS delta_v_mean_b_km_h,
       sum(a.olc_g > b.olc_g) AS a_higher, sum(b.olc_g > a.olc_g) AS b_higher
FROM crash_vehicle AS a
JOIN crash_vehicle AS b ON b.crash_id = a.crash_id AND b.role = 'b'
JOIN variant AS v ON v.id = a.variant_id
WHERE a.role = 'a' AND a.crash_type = 'front-front'
GROUP BY v.id, a.vehicle_model, b.vehicle_model
ORDER BY v.number, model_a, model_b;
