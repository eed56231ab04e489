-- SPDX-License-Identifier: GPL-3.0-or-later
-- Which crash configurations occur? Frontal crashes counted in cells of lateral offset (25 cm) and
-- angle (15 degrees; 0 = exactly oncoming), with the mean closing speed of a cell. offset_m and
-- angle_deg are the middle of the cell.
SELECT variant, crash_type,
       0.25 * round(lateral_offset_m / 0.25) AS offset_m,
       15.0 * round(degrees(angle_rad) / 15.0) AS angle_deg,
       count(*) AS crashes, sum(validity = 'inside') AS inside_validity,
       round(3.6 * avg(closing_speed_m_s), 1) AS closing_speed_mean_km_h
FROM crash_list
WHERE frontal
GROUP BY variant, crash_type, offset_m, angle_deg
ORDER BY variant, crash_type, offset_m, angle_deg;
