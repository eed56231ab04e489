-- SPDX-License-Identifier: GPL-3.0-or-later
-- What did the two do in the last seconds before they met? For each crash and car its speed when the
-- stored history begins and just before contact, and its hardest braking between (history_s in the
-- study file).
SELECT scenario, variant, crash_id, role, sumo_id, at_fault,
       round(-min(from_contact_s), 2) AS known_s,
       round(3.6 * max(CASE WHEN number = 0 THEN speed_m_s END), 1) AS speed_then_km_h,
       round(3.6 * max(CASE WHEN is_last THEN speed_m_s END), 1) AS speed_at_contact_km_h,
       round(-min(acceleration_m_s2), 1) AS hardest_braking_m_s2
FROM (SELECT *, number = max(number) OVER (PARTITION BY crash_id, role) AS is_last FROM pre_crash)
GROUP BY crash_id, role
ORDER BY crash_id, role;
