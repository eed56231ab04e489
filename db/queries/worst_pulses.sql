-- SPDX-License-Identifier: GPL-3.0-or-later
-- What did the worst pulses look like? Deceleration (g, CFC60) and velocity (km/h) of the three
-- vehicles with the highest OLC among those with a stored pulse, every 5 ms of the first 150 ms.
-- Needs the SQL extension (pulse_samples, cfc).
WITH worst AS (
    SELECT crash_id, role, olc_g, samples FROM crash_vehicle JOIN pulse USING (crash_id, role)
    WHERE olc_g IS NOT NULL
    ORDER BY olc_g DESC, crash_id, role LIMIT 3
)
SELECT w.crash_id, w.role, round(w.olc_g, 1) AS olc_g, round(1000 * p.time_s) AS time_ms,
       round(-p.ax_m_s2 / 9.80665, 1) AS deceleration_g, round(3.6 * p.vx_m_s, 1) AS vx_km_h
FROM worst AS w, pulse_samples(cfc(w.samples, 60)) AS p
WHERE p.time_s < 0.1501 AND p.sample % 5 = 0
ORDER BY w.olc_g DESC, w.crash_id, w.role, p.sample;
