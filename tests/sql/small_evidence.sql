-- SPDX-License-Identifier: GPL-3.0-or-later
-- For an invented study whose crashes no test spoke for: those inside lie within two classes by their number,
-- role a was drawn.
UPDATE crash_vehicle
SET evidence_class = CASE crash_id % 2 WHEN 0 THEN 'wall' ELSE 'offset' END,
    class_error_1 = CASE crash_id % 2 WHEN 0 THEN 0.1 ELSE 0.25 END,
    class_error_g = CASE crash_id % 2 WHEN 0 THEN 0.1 ELSE 0.25 END * coalesce(olc_g, 0.0)
WHERE validity = 'inside' AND frontal = 1 AND olc_status <> 'simulation_failed';
UPDATE crash_vehicle SET drawn = '{"mass_kg":' || mass_kg || '}' WHERE role = 'a';
