-- SPDX-License-Identifier: GPL-3.0-or-later
-- For an invented study whose crashes no test spoke for: those inside lie within two classes by their number,
-- role a was drawn, and who was struck elsewhere was pushed in by a centimetre for every crash's number.
UPDATE crash_vehicle
SET evidence_class = CASE crash_id % 2 WHEN 0 THEN 'wall' ELSE 'offset' END,
    class_error_1 = CASE crash_id % 2 WHEN 0 THEN 0.1 ELSE 0.25 END,
    class_error_g = CASE crash_id % 2 WHEN 0 THEN 0.1 ELSE 0.25 END * coalesce(olc_g, 0.0)
WHERE validity = 'inside' AND frontal = 1 AND olc_status <> 'simulation_failed';
UPDATE crash_vehicle SET drawn = '{"mass_kg":' || mass_kg || '}' WHERE role = 'a';
UPDATE crash_vehicle
SET intrusion_m = 0.01 * (1 + crash_id % 30),
    intrusion_zone = CASE contact_side WHEN 'rear' THEN 'rear' ELSE 'door' END,
    delta_v_y_m_s = 0.5 * delta_v_m_s, asi_1 = 0.1 * delta_v_m_s
WHERE frontal = 0;
