-- SPDX-License-Identifier: GPL-3.0-or-later
-- How hard are cars struck on a side or the rear? Each variant's struck vehicles by crash type and zone:
-- medians of lateral and whole delta-v, ASI, how far the zone was pushed in for good, and the mean mass
-- ratio of who struck to who was struck. OLC says nothing of them.
SELECT variant, crash_type, coalesce(intrusion_zone, contact_side) AS zone, count(*) AS vehicles,
       round(avg(other_mass_kg / mass_kg), 2) AS mass_ratio,
       round(3.6 * max(abs(delta_v_y_m_s)) FILTER (WHERE by_lateral <= (n + 1) / 2), 1) AS lateral_delta_v_km_h,
       round(3.6 * max(delta_v_m_s) FILTER (WHERE by_delta_v <= (n + 1) / 2), 1) AS delta_v_km_h,
       round(max(asi_1) FILTER (WHERE by_asi <= (n + 1) / 2), 2) AS asi_1,
       round(1000 * max(intrusion_m) FILTER (WHERE by_intrusion <= (n + 1) / 2)) AS intrusion_mm
FROM (SELECT *, count(*) OVER struck AS n,
             row_number() OVER (struck ORDER BY abs(delta_v_y_m_s)) AS by_lateral,
             row_number() OVER (struck ORDER BY delta_v_m_s) AS by_delta_v,
             row_number() OVER (struck ORDER BY asi_1) AS by_asi,
             row_number() OVER (struck ORDER BY intrusion_m) AS by_intrusion
      FROM struck_vehicle
      WHERE delta_v_m_s IS NOT NULL
      WINDOW struck AS (PARTITION BY variant, crash_type, coalesce(intrusion_zone, contact_side)))
GROUP BY variant, crash_type, zone
ORDER BY variant, crash_type, vehicles DESC, zone;
