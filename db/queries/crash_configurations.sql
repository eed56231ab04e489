-- SPDX-License-Identifier: GPL-3.0-or-later
-- How do the crashes of each scenario look? By crash type: crashes an hour of traffic, closing speed
-- (mean, smallest, quartiles, largest), mean lateral offset to either side, and how far from exactly
-- oncoming (0 degrees) the two meet: mean, and the share within 15 degrees.
WITH hours AS (
    SELECT s.name AS scenario, v.name AS variant, sum(r.simulated_s) / 3600.0 AS hours
    FROM replication AS r
    JOIN scenario AS s ON s.id = r.scenario_id
    JOIN variant AS v ON v.id = r.variant_id
    WHERE r.status = 'done'
    GROUP BY s.id, v.id),
ranked AS (
    SELECT *, 3.6 * closing_speed_m_s AS closing_km_h, abs(degrees(angle_rad)) AS oblique_deg,
           row_number() OVER (PARTITION BY scenario, variant, crash_type
                              ORDER BY closing_speed_m_s) AS place,
           count(*) OVER (PARTITION BY scenario, variant, crash_type) AS crashes
    FROM crash_list)
SELECT scenario, variant, crash_type, max(crashes) AS crashes,
       round(max(crashes) / max(hours), 1) AS per_hour,
       round(avg(closing_km_h), 1) AS closing_mean_km_h,
       round(min(closing_km_h), 1) AS closing_min_km_h,
       round(min(CASE WHEN 4 * place >= crashes THEN closing_km_h END), 1) AS closing_quartile_km_h,
       round(min(CASE WHEN 2 * place >= crashes THEN closing_km_h END), 1) AS closing_median_km_h,
       round(min(CASE WHEN 4 * place >= 3 * crashes THEN closing_km_h END), 1)
           AS closing_upper_quartile_km_h,
       round(max(closing_km_h), 1) AS closing_max_km_h,
       round(avg(abs(lateral_offset_m)), 2) AS offset_mean_m,
       round(avg(oblique_deg), 1) AS oblique_mean_deg,
       round(max(oblique_deg), 1) AS oblique_max_deg,
       round(avg(oblique_deg <= 15.0), 3) AS within_15_deg_1
FROM ranked JOIN hours USING (scenario, variant)
GROUP BY scenario, variant, crash_type
ORDER BY scenario, variant, crash_type;
