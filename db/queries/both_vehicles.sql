-- SPDX-License-Identifier: GPL-3.0-or-later
-- Who has it worse? Front-to-front crashes by the models of the two vehicles: mean OLC and delta-v of
-- a and of b, and how often each has the higher OLC. No mean OLC where some are left-censored: below
-- every value, they cannot be averaged, and are not left out.
SELECT v.name AS variant, a.vehicle_model AS model_a, b.vehicle_model AS model_b,
       count(*) AS crashes,
       CASE WHEN sum(a.olc_status IN ('no_deceleration', 'beyond_0_5_s')) = 0
            THEN round(avg(a.olc_g), 2) END AS olc_mean_a_g,
       CASE WHEN sum(b.olc_status IN ('no_deceleration', 'beyond_0_5_s')) = 0
            THEN round(avg(b.olc_g), 2) END AS olc_mean_b_g,
       round(3.6 * avg(a.delta_v_m_s), 1) AS delta_v_mean_a_km_h,
       round(3.6 * avg(b.delta_v_m_s), 1) AS delta_v_mean_b_km_h,
       sum(a.olc_g > CASE WHEN b.olc_status IN ('no_deceleration', 'beyond_0_5_s') THEN 0.0
                     ELSE b.olc_g END) AS a_higher,
       sum(b.olc_g > CASE WHEN a.olc_status IN ('no_deceleration', 'beyond_0_5_s') THEN 0.0
                     ELSE a.olc_g END) AS b_higher
FROM crash_vehicle AS a
JOIN crash_vehicle AS b ON b.crash_id = a.crash_id AND b.role = 'b'
JOIN variant AS v ON v.id = a.variant_id
WHERE a.role = 'a' AND a.crash_type = 'front-front'
GROUP BY v.id, a.vehicle_model, b.vehicle_model
ORDER BY v.number, model_a, model_b;
