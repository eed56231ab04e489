-- SPDX-License-Identifier: GPL-3.0-or-later
-- How does severity grow with speed? Median and 90th percentile of OLC in classes of closing speed
-- (10 km/h wide, by their lower end) for every variant, left-censored vehicles below every value: a
-- figure among them is NULL. Needs the SQL extension (median, quantile).
SELECT variant, 10 * CAST(3.6 * closing_speed_m_s / 10 AS INTEGER) AS closing_speed_from_km_h,
       count(*) AS vehicles, sum(censored) AS censored,
       round(median(olc_g, censored), 2) AS olc_median_g,
       round(quantile(olc_g, 0.9, censored), 2) AS olc_p90_g
FROM frontal_vehicle
WHERE olc_status <> 'simulation_failed'
GROUP BY variant, closing_speed_from_km_h
ORDER BY variant, closing_speed_from_km_h;
