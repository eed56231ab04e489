-- SPDX-License-Identifier: GPL-3.0-or-later
-- How often does it crash? Exposure, crashes and crash rates of every scenario and variant, over the
-- finished replications, those without a crash included. Rates are per million vehicle-km and
-- conditional on the driver errors of the study (table scenario, column driver_errors).
SELECT scenario, variant, replications, round(vehicle_km, 1) AS vehicle_km,
       round(vehicle_h, 1) AS vehicle_h, crashes, frontal_crashes,
       frontal_crashes_per_million_km
FROM crash_rate_by_scenario;
