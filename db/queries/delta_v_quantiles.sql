-- SPDX-License-Identifier: GPL-3.0-or-later
-- How large are the changes of velocity? Quantiles of delta-v (km/h) of all vehicles by variant and
-- struck side: what injury risk functions start from. Needs the SQL extension (quantile).
SELECT v.name AS variant, x.contact_side, count(*) AS vehicles,
       round(3.6 * quantile(delta_v_m_s, 0.25), 1) AS q25_km_h,
       round(3.6 * median(delta_v_m_s), 1) AS median_km_h,
       round(3.6 * quantile(delta_v_m_s, 0.75), 1) AS q75_km_h,
       round(3.6 * quantile(delta_v_m_s, 0.95), 1) AS p95_km_h
FROM crash_vehicle AS x JOIN variant AS v ON v.id = x.variant_id
WHERE delta_v_m_s IS NOT NULL
GROUP BY v.id, x.contact_side
ORDER BY v.number, x.contact_side;
