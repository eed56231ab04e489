-- SPDX-License-Identifier: GPL-3.0-or-later
-- What does a typical pulse look like? Mean, median and 90th percentile of the deceleration (g, as
-- stored: CFC180) over the frontally struck vehicles of each variant, every 10 ms after first contact.
-- Needs the SQL extension (pulse_samples).
SELECT v.name AS variant, round(1000 * p.time_s) AS time_ms, count(*) AS vehicles,
       round(avg(-p.ax_m_s2) / 9.80665, 2) AS mean_g,
       round(median(-p.ax_m_s2) / 9.80665, 2) AS median_g,
       round(quantile(-p.ax_m_s2, 0.9) / 9.80665, 2) AS p90_g
FROM crash_vehicle AS x
JOIN variant AS v ON v.id = x.variant_id
JOIN pulse_samples(x.crash_id, x.role) AS p
WHERE x.frontal = 1 AND p.sample % 10 = 0 AND p.time_s < 0.2001
GROUP BY v.id, p.sample
ORDER BY v.number, p.sample;
