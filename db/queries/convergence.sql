-- SPDX-License-Identifier: GPL-3.0-or-later
-- Has the study run long enough? For every variant, replication by replication: frontal crashes so
-- far, their rate, and the median OLC of all vehicles so far. When the last rows still wander, more
-- replications are needed. Needs the SQL extension (median as a window function).
WITH vehicle AS (
    SELECT f.variant_id, r.number AS replication, f.olc_g, f.censored
    FROM frontal_vehicle AS f JOIN replication AS r ON r.id = f.replication_id
    WHERE f.olc_status <> 'simulation_failed'
), running AS (
    SELECT DISTINCT variant_id, replication,
           median(olc_g, censored) OVER (PARTITION BY variant_id ORDER BY replication
               RANGE BETWEEN UNBOUNDED PRECEDING AND CURRENT ROW) AS olc_median_g
    FROM vehicle
), rate AS (
    SELECT variant, variant_id, replication, sum(sum(frontal_crashes)) OVER so_far AS frontal_crashes,
           1e6 * sum(sum(frontal_crashes)) OVER so_far / sum(sum(vehicle_km)) OVER so_far
               AS per_million_km
    FROM replication_crashes
    GROUP BY variant_id, replication
    WINDOW so_far AS (PARTITION BY variant_id ORDER BY replication)
)
SELECT rate.variant, rate.replication, rate.frontal_crashes,
       round(rate.per_million_km, 1) AS frontal_crashes_per_million_km,
       round(running.olc_median_g, 2) AS olc_median_g
FROM rate LEFT JOIN running USING (variant_id, replication)
ORDER BY rate.variant, rate.replication;
