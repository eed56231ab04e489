-- SPDX-License-Identifier: GPL-3.0-or-later
-- The twenty frontally struck vehicles with the highest OLC, with what is needed to look at them
-- again: scenario, variant, seed, time and SUMO id.
SELECT scenario, variant, seed, round(time_s, 2) AS time_s, sumo_id, crash_type,
       round(olc_g, 1) AS olc_g, round(3.6 * closing_speed_m_s, 1) AS closing_speed_km_h,
       round(1000 * lateral_offset_m) AS offset_mm, round(degrees(angle_rad), 1) AS angle_deg,
       validity
FROM frontal_vehicle
WHERE olc_g IS NOT NULL
ORDER BY frontal_vehicle.olc_g DESC, crash_id, role
LIMIT 20;
