-- SPDX-License-Identifier: GPL-3.0-or-later
-- How often does it crash, over all scenarios? Exposure, crashes and crash rates of every variant, over
-- the finished replications, those without a crash included; per scenario: exposure_and_rates.sql.
SELECT variant, replications, round(vehicle_km, 1) AS vehicle_km, crashes, frontal_crashes,
       frontal_crashes_per_million_km
FROM crash_rate_by_variant;
