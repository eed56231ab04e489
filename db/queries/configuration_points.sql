-- SPDX-License-Identifier: GPL-3.0-or-later
-- Which crash configurations occur, crash by crash? Lateral offset of the opponent and angle (0 =
-- exactly oncoming) seen from car a, closing speed, and whether a's severity lies inside the validated
-- range; counted in cells: configuration_map.sql.
SELECT c.variant, c.scenario, c.crash_type, round(c.lateral_offset_m, 3) AS lateral_offset_m,
       round(degrees(c.angle_rad), 2) AS angle_deg,
       round(3.6 * c.closing_speed_m_s, 1) AS closing_speed_km_h, a.validity
FROM crash_list AS c
JOIN crash_vehicle AS a ON a.crash_id = c.id AND a.role = 'a'
WHERE c.frontal
ORDER BY c.variant, c.scenario, c.id;
