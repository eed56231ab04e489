-- SPDX-License-Identifier: GPL-3.0-or-later
-- Which pulses are there? One row a frontally struck vehicle; sample_count is NULL without a pulse.
-- Corridors are quantiles over these, CFC60, at each instant; the SQL extension unpacks a pulse:
-- SELECT * FROM pulse_samples(crash_id, role).
SELECT v.scenario, v.variant, v.crash_id, v.role, v.olc_g, v.validity, p.sample_count,
       p.sample_interval_s
FROM frontal_vehicle AS v
LEFT JOIN pulse AS p ON p.crash_id = v.crash_id AND p.role = v.role
ORDER BY v.scenario, v.variant, v.crash_id, v.role;
