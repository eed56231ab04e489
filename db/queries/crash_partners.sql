-- SPDX-License-Identifier: GPL-3.0-or-later
-- Heavy against light: frontally struck cars by their model and their opponent's, both masses, and the
-- mean delta-v beside the share of the closing speed that momentum alone gives a car (the opponent's
-- share of both masses; oncoming and centred). Without cars whose mass is not known.
SELECT v.name AS variant, a.vehicle_model AS model, b.vehicle_model AS opponent_model,
       round(avg(a.mass_kg)) AS mass_kg, round(avg(b.mass_kg)) AS opponent_mass_kg,
       count(*) AS cars, round(3.6 * avg(a.delta_v_m_s), 1) AS delta_v_mean_km_h,
       round(avg(a.delta_v_m_s / c.closing_speed_m_s), 3) AS delta_v_per_closing_speed_1,
       round(avg(b.mass_kg / (a.mass_kg + b.mass_kg)), 3) AS opponent_mass_share_1
FROM crash_vehicle AS a
JOIN crash_vehicle AS b ON b.crash_id = a.crash_id AND b.role <> a.role
JOIN crash AS c ON c.id = a.crash_id
JOIN variant AS v ON v.id = a.variant_id
WHERE a.frontal = 1 AND a.mass_kg IS NOT NULL AND b.mass_kg IS NOT NULL
GROUP BY v.id, a.vehicle_model, b.vehicle_model
ORDER BY v.number, model, opponent_model;
