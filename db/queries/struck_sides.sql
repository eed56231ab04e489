-- SPDX-License-Identifier: GPL-3.0-or-later
-- Struck on a side or the rear: by type of crash, struck side and zone the mean delta-v, its lateral part,
-- ASI (EN 1317-1:1998), the intrusion (permanent, from the outline) and the ratio of the striking
-- vehicle's mass to the struck one's. OLC says nothing of them. Without what could not be simulated.
SELECT v.name AS variant, w.crash_type, w.contact_side, w.intrusion_zone AS zone,
       count(*) AS vehicles,
       round(3.6 * avg(w.delta_v_m_s), 1) AS delta_v_mean_km_h,
       round(3.6 * avg(abs(w.delta_v_y_m_s)), 1) AS delta_v_y_mean_km_h,
       round(avg(w.asi_1), 2) AS asi_mean_1,
       round(1000.0 * avg(w.intrusion_m)) AS intrusion_mean_mm,
       round(1000.0 * max(w.intrusion_m)) AS intrusion_max_mm,
       round(avg(o.mass_kg / w.mass_kg), 2) AS striking_mass_ratio_1
FROM crash_vehicle AS w
JOIN crash_vehicle AS o ON o.crash_id = w.crash_id AND o.role <> w.role
JOIN variant AS v ON v.id = w.variant_id
WHERE w.frontal = 0 AND w.intrusion_m IS NOT NULL
GROUP BY v.id, w.crash_type, w.contact_side, w.intrusion_zone
ORDER BY v.number, w.crash_type, w.contact_side, w.intrusion_zone;
