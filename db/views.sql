-- SPDX-License-Identifier: GPL-3.0-or-later
-- Views for everyone who asks the database. Only finished replications have crashes, so no view
-- over crashes needs to look at the status. Every crash has one row of role a and one of role b,
-- and a is struck on its front in every frontal crash.

-- One row a confirmed crash, with names in place of ids.
DROP VIEW IF EXISTS crash_list;
CREATE VIEW crash_list AS
SELECT s.name AS scenario, v.name AS variant, r.number AS replication, r.seed AS seed, c.*,
       c.crash_type LIKE 'front-%' AS frontal
FROM crash AS c
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id;

-- One row a frontally struck vehicle: the observation unit of OLC distributions. censored = 1: its
-- OLC lies below every value.
DROP VIEW IF EXISTS frontal_vehicle;
CREATE VIEW frontal_vehicle AS
SELECT s.name AS scenario, v.name AS variant, r.number AS replication, r.seed AS seed,
       r.id AS replication_id, c.time_s AS time_s, c.closing_speed_m_s AS closing_speed_m_s,
       c.lateral_offset_m AS lateral_offset_m, c.angle_rad AS angle_rad,
       c.overlap_1 AS overlap_1, cv.*,
       cv.olc_status IN ('no_deceleration', 'beyond_0_5_s') AS censored
FROM crash_vehicle AS cv
JOIN crash AS c ON c.id = cv.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = cv.scenario_id
JOIN variant AS v ON v.id = cv.variant_id
WHERE cv.frontal = 1;

-- Which model each SUMO vehicle type crashed as (of a type whose cars are drawn all of them), and why:
-- chosen_by is study, sumo_type, study_default, class_and_size, fleet or market; without a model, reason
-- says why (README, "Which car a SUMO vehicle crashes as").
DROP VIEW IF EXISTS vehicle_type_model;
CREATE VIEW vehicle_type_model AS
SELECT s.name AS scenario, t.key AS sumo_type, t.value ->> 'model' AS vehicle_model,
       t.value ->> 'chosen_by' AS chosen_by, t.value ->> 'reason' AS reason,
       count(*) AS replications
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN json_each(r.crash_options, '$.vehicle_types') AS t
GROUP BY s.number, t.key, vehicle_model, chosen_by, reason;

-- Whether a crash lies within 20 m of where the network without driver errors had one itself (a flagged
-- site): then it may be the network's doing. 0 too where no background was simulated.
DROP VIEW IF EXISTS crash_site;
CREATE VIEW crash_site AS
SELECT c.id AS crash_id, r.id AS replication_id, r.scenario_id AS scenario_id,
       r.variant_id AS variant_id,
       EXISTS (SELECT 1 FROM scenario AS s
               JOIN scenario AS x ON (x.sumocfg, x.sumo_options, x.files)
                                     = (s.sumocfg, s.sumo_options, s.files)
               JOIN background_contact AS b ON b.scenario_id = x.id
               WHERE s.id = r.scenario_id AND b.reason = 'crash'
                 AND (b.x_m - c.x_m) * (b.x_m - c.x_m) + (b.y_m - c.y_m) * (b.y_m - c.y_m)
                     <= 20.0 * 20.0) AS at_flagged_site
FROM crash AS c
JOIN replication AS r ON r.id = c.replication_id;

-- Every vehicle of every crash, struck on whichever side: what --where and --by of 'crashpulse
-- compare' choose from.
DROP VIEW IF EXISTS crash_vehicle_list;
CREATE VIEW crash_vehicle_list AS
SELECT s.name AS scenario, v.name AS variant, r.sweep AS sweep, r.number AS replication,
       r.seed AS seed, r.id AS replication_id, c.time_s AS time_s, c.x_m AS x_m, c.y_m AS y_m,
       c.closing_speed_m_s AS closing_speed_m_s, c.lateral_offset_m AS lateral_offset_m,
       c.angle_rad AS angle_rad, c.overlap_1 AS overlap_1, c.validity AS crash_validity,
       (SELECT f.at_flagged_site FROM crash_site AS f WHERE f.crash_id = c.id) AS at_flagged_site, cv.*
FROM crash_vehicle AS cv
JOIN crash AS c ON c.id = cv.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = cv.scenario_id
JOIN variant AS v ON v.id = cv.variant_id;

-- Why a vehicle's severity lies outside the validated range: one row a reason, none for a vehicle that
-- lies inside (its validity is the list of them, or 'inside').
DROP VIEW IF EXISTS validity_reason;
CREATE VIEW validity_reason AS
SELECT s.name AS scenario, v.name AS variant, cv.crash_id, cv.role, cv.frontal, cv.crash_type,
       r.value AS reason
FROM crash_vehicle AS cv
JOIN scenario AS s ON s.id = cv.scenario_id
JOIN variant AS v ON v.id = cv.variant_id
JOIN json_each('["' || replace(cv.validity, ',', '","') || '"]') AS r
WHERE cv.validity <> 'inside';

-- Vehicles struck on a side or their rear, each with who struck it: OLC says nothing of them, lateral
-- delta-v, direction of force, ASI and intrusion do.
DROP VIEW IF EXISTS struck_vehicle;
CREATE VIEW struck_vehicle AS
SELECT s.name AS scenario, v.name AS variant, r.number AS replication, r.seed AS seed,
       c.closing_speed_m_s AS closing_speed_m_s, c.angle_rad AS angle_rad, w.sumo_id AS other_sumo_id,
       w.vehicle_model AS other_model, w.mass_kg AS other_mass_kg, w.contact_side AS other_side,
       w.olc_g AS other_olc_g, w.olc_status AS other_olc_status, cv.*
FROM crash_vehicle AS cv
JOIN crash_vehicle AS w ON w.crash_id = cv.crash_id AND w.role <> cv.role
JOIN crash AS c ON c.id = cv.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = cv.scenario_id
JOIN variant AS v ON v.id = cv.variant_id
WHERE cv.frontal = 0;

-- One row for each driver error that led to a crash (crash_driver_error.is_cause): whose it was, and
-- how many led to it. None for a crash without a driver error, nor for one whose crash_vehicle.error_count
-- is NULL: of an earlier version or of files, where it is not known.
DROP VIEW IF EXISTS crash_cause;
CREATE VIEW crash_cause AS
SELECT s.name AS scenario, v.name AS variant, c.replication_id, e.crash_id, e.role, w.sumo_id,
       w.sumo_type, w.crash_type, e.number, e.driver_error, e.towards, e.began_s, e.ended_s,
       count(*) OVER (PARTITION BY e.crash_id) AS causes
FROM crash_driver_error AS e
JOIN crash_vehicle AS w ON w.crash_id = e.crash_id AND w.role = e.role
JOIN crash AS c ON c.id = e.crash_id
JOIN scenario AS s ON s.id = w.scenario_id
JOIN variant AS v ON v.id = w.variant_id
WHERE e.is_cause = 1;

-- One row for each crashed car and function of its variant, by state at contact. is_treated: 1 of the
-- treated crash of a counterfactual pair, whose crash_id is the baseline's.
DROP VIEW IF EXISTS function_at_contact;
CREATE VIEW function_at_contact AS
SELECT s.name AS scenario, v.name AS variant, c.replication_id, 0 AS is_treated, f.crash_id, f.role,
       w.sumo_id, w.crash_type, w.frontal, w.speed_m_s, f.number, f.function, f.state, f.warned_s,
       f.requested_s, f.braking_s, f.steering_s, f.released_s, f.brake_request_m_s2,
       f.deceleration_m_s2, f.speed_taken_off_m_s
FROM crash_function AS f
JOIN crash_vehicle AS w ON w.crash_id = f.crash_id AND w.role = f.role
JOIN crash AS c ON c.id = f.crash_id
JOIN scenario AS s ON s.id = w.scenario_id
JOIN variant AS v ON v.id = w.variant_id
UNION ALL
SELECT s.name, v.name, c.replication_id, 1, f.crash_id, f.role, w.sumo_id, x.crash_type, w.frontal,
       w.speed_m_s, f.number, f.function, f.state, f.warned_s, f.requested_s, f.braking_s,
       f.steering_s, f.released_s, f.brake_request_m_s2, f.deceleration_m_s2, f.speed_taken_off_m_s
FROM counterfactual_function AS f
JOIN counterfactual_vehicle AS w
     ON w.crash_id = f.crash_id AND w.variant_id = f.variant_id AND w.role = f.role
JOIN counterfactual AS x ON x.crash_id = f.crash_id AND x.variant_id = f.variant_id
JOIN crash AS c ON c.id = f.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = f.variant_id;

-- OLC over the frontally struck vehicles of each variant. The median counts left-censored vehicles
-- below every value; NULL when it falls among them (then it is below the smallest value) or when
-- there is no vehicle. share_inside_validity: of the frontal vehicles.
DROP VIEW IF EXISTS olc_by_variant;
CREATE VIEW olc_by_variant AS
WITH counted AS (
    -- of vehicles with an OLC, left-censored ones included
    SELECT variant_id, count(*) AS n, count(*) - count(olc_g) AS censored, avg(olc_g) AS mean_g
    FROM crash_vehicle
    WHERE olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')
    GROUP BY variant_id
), by_role AS (
    SELECT variant_id, role, count(*) AS vehicles, sum(frontal) AS frontal,
           sum(frontal AND olc_status = 'simulation_failed') AS simulation_failed,
           sum(frontal AND validity = 'inside') AS inside_validity
    FROM crash_vehicle
    GROUP BY variant_id, role
), vehicles AS (
    SELECT variant_id,
           sum(CASE WHEN role = 'a' THEN vehicles END) AS crashes,
           sum(CASE WHEN role = 'a' THEN frontal END) AS frontal_crashes,
           sum(frontal) AS frontal_vehicles, sum(simulation_failed) AS simulation_failed,
           sum(inside_validity) AS inside_validity
    FROM by_role
    GROUP BY variant_id
)
SELECT v.name AS variant, v.id AS variant_id, v.is_baseline AS is_baseline,
       coalesce(x.crashes, 0) AS crashes,
       coalesce(x.frontal_crashes, 0) AS frontal_crashes,
       coalesce(x.frontal_vehicles, 0) AS frontal_vehicles,
       coalesce(k.censored, 0) AS censored,
       coalesce(x.simulation_failed, 0) AS simulation_failed,
       -- the middle one or the mean of the two in the middle; no value if either is censored. The
       -- inner LIMIT lets the walk along the index end there.
       (SELECT CASE WHEN count(olc_g) = count(*) THEN avg(olc_g) END
        FROM (SELECT olc_g, place
              FROM (SELECT olc_g, row_number() OVER (ORDER BY olc_g) AS place
                    FROM crash_vehicle AS o
                    WHERE o.variant_id = v.id
                      AND o.olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s'))
              WHERE place >= (k.n + 1) / 2 LIMIT 2)
        WHERE place <= k.n / 2 + 1) AS olc_median_g,
       -- NULL with left-censored vehicles: without them it would rise as crashes get milder
       CASE WHEN k.censored = 0 THEN k.mean_g END AS olc_mean_g,
       (SELECT min(o.olc_g) FROM crash_vehicle AS o
        WHERE o.variant_id = v.id
          AND o.olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')) AS olc_min_g,
       (SELECT max(o.olc_g) FROM crash_vehicle AS o
        WHERE o.variant_id = v.id
          AND o.olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')) AS olc_max_g,
       coalesce(x.inside_validity, 0) AS inside_validity,
       1.0 * x.inside_validity / nullif(x.frontal_vehicles, 0) AS share_inside_validity
FROM variant AS v
LEFT JOIN vehicles AS x ON x.variant_id = v.id
LEFT JOIN counted AS k ON k.variant_id = v.id
ORDER BY v.number;

-- Median OLC of each variant by every parameter set (member) of the vehicle models' ensembles, sets
-- that every vehicle with an ensemble has. n: vehicles with an OLC by the set, left-censored ones
-- included; with_sets: of these whose model has an ensemble, the others keep their own OLC in every
-- set. The median is NULL where it is left-censored. The scatter of the medians over the sets is the
-- part of the model: a set that is wrong is wrong for all crashes.
DROP VIEW IF EXISTS olc_by_variant_member;
CREATE VIEW olc_by_variant_member AS
WITH sets AS (
    SELECT count(*) AS n, max(member) + 1 AS numbered FROM crash_vehicle_member
    GROUP BY crash_id, role
    UNION ALL
    SELECT count(*), max(member) + 1 FROM counterfactual_vehicle_member
    GROUP BY crash_id, variant_id, role
), common AS (
    SELECT DISTINCT member FROM crash_vehicle_member
    WHERE member < (SELECT min(CASE WHEN n = numbered THEN n ELSE 0 END) FROM sets)
), by_set AS (
    SELECT w.variant_id, s.member, m.member IS NOT NULL AS has_set,
           CASE WHEN m.member IS NULL THEN w.olc_g ELSE m.olc_g END AS olc_g
    FROM crash_vehicle AS w CROSS JOIN common AS s
    LEFT JOIN crash_vehicle_member AS m
           ON m.crash_id = w.crash_id AND m.role = w.role AND m.member = s.member
    WHERE w.olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')
      AND coalesce(m.olc_status, '') <> 'simulation_failed'
), placed AS (
    SELECT *, row_number() OVER (PARTITION BY variant_id, member ORDER BY olc_g) AS place,
           count(*) OVER (PARTITION BY variant_id, member) AS n,
           sum(has_set) OVER (PARTITION BY variant_id, member) AS with_sets
    FROM by_set
)
SELECT v.name AS variant, v.id AS variant_id, v.is_baseline AS is_baseline, p.member AS member,
       p.n AS n, p.with_sets AS with_sets,
       -- the middle one or the mean of the two in the middle; no value if either is censored
       CASE WHEN count(p.olc_g) = count(*) THEN avg(p.olc_g) END AS olc_median_g
FROM placed AS p
JOIN variant AS v ON v.id = p.variant_id
WHERE p.place IN ((p.n + 1) / 2, p.n / 2 + 1)
GROUP BY v.id, p.member
ORDER BY v.number, p.member;

-- What olc_by_variant shows, for each scenario and variant.
DROP VIEW IF EXISTS olc_by_scenario;
CREATE VIEW olc_by_scenario AS
WITH vehicles AS (
    SELECT variant_id, scenario_id,
           sum(olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')) AS n,
           sum(role = 'a') AS crashes,
           sum(role = 'a' AND frontal = 1) AS frontal_crashes,
           sum(frontal) AS frontal_vehicles,
           sum(frontal = 1 AND olc_status IN ('no_deceleration', 'beyond_0_5_s')) AS censored,
           sum(frontal = 1 AND validity = 'inside') AS inside_validity
    FROM crash_vehicle
    GROUP BY variant_id, scenario_id
)
SELECT s.name AS scenario, v.name AS variant, s.id AS scenario_id, v.id AS variant_id,
       coalesce(x.crashes, 0) AS crashes,
       coalesce(x.frontal_crashes, 0) AS frontal_crashes,
       coalesce(x.frontal_vehicles, 0) AS frontal_vehicles,
       coalesce(x.censored, 0) AS censored,
       (SELECT CASE WHEN count(olc_g) = count(*) THEN avg(olc_g) END
        FROM (SELECT olc_g, place
              FROM (SELECT olc_g, row_number() OVER (ORDER BY olc_g) AS place
                    FROM crash_vehicle AS o
                    WHERE o.variant_id = v.id AND o.scenario_id = s.id
                      AND o.olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s'))
              WHERE place >= (x.n + 1) / 2 LIMIT 2)
        WHERE place <= x.n / 2 + 1) AS olc_median_g,
       coalesce(x.inside_validity, 0) AS inside_validity,
       1.0 * x.inside_validity / nullif(x.frontal_vehicles, 0) AS share_inside_validity
FROM scenario AS s CROSS JOIN variant AS v
LEFT JOIN vehicles AS x ON x.variant_id = v.id AND x.scenario_id = s.id
ORDER BY s.number, v.number;

-- Counts of every finished replication, those without a crash included: what rates and bootstrap
-- over replications start from.
DROP VIEW IF EXISTS replication_crashes;
CREATE VIEW replication_crashes AS
SELECT r.id AS replication_id, s.name AS scenario, v.name AS variant, r.scenario_id AS scenario_id,
       r.variant_id AS variant_id, r.number AS replication, r.seed AS seed,
       r.vehicle_km AS vehicle_km, r.vehicle_h AS vehicle_h, r.simulated_s AS simulated_s,
       (SELECT count(*) FROM crash AS c WHERE c.replication_id = r.id) AS crashes,
       (SELECT count(*) FROM crash AS c
        WHERE c.replication_id = r.id AND c.crash_type LIKE 'front-%') AS frontal_crashes
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
WHERE r.status = 'done'
ORDER BY s.number, v.number, r.number;

-- What flagged sites (crash_site) take from and add to the rates of a scenario: crashes at them, and the
-- rate with and without. A contrast without them, with its interval: 'crashpulse compare DB --where
-- "at_flagged_site = 0"'.
DROP VIEW IF EXISTS flagged_sites;
CREATE VIEW flagged_sites AS
SELECT s.name AS scenario, v.name AS variant, s.id AS scenario_id, v.id AS variant_id,
       v.is_baseline AS is_baseline, sum(x.crashes) AS crashes, sum(x.flagged) AS crashes_at_flagged,
       sum(x.vehicle_km) AS vehicle_km,
       1e6 * sum(x.crashes) / nullif(sum(x.vehicle_km), 0.0) AS crashes_per_million_km,
       1e6 * sum(x.crashes - x.flagged) / nullif(sum(x.vehicle_km), 0.0)
           AS crashes_per_million_km_without
FROM (SELECT r.scenario_id, r.variant_id, r.vehicle_km AS vehicle_km,
             (SELECT count(*) FROM crash_site AS c WHERE c.replication_id = r.id) AS crashes,
             (SELECT count(*) FROM crash_site AS c
              WHERE c.replication_id = r.id AND c.at_flagged_site) AS flagged
      FROM replication AS r WHERE r.status = 'done') AS x
JOIN scenario AS s ON s.id = x.scenario_id
JOIN variant AS v ON v.id = x.variant_id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;

-- How often the driver errors of a scenario acted in its finished replications of the baseline. acted = 0:
-- it cannot on this network, or hardly ever does (red_light without traffic lights, misjudged_gap and
-- failed_to_see without crossings to yield at); NULL: not counted.
DROP VIEW IF EXISTS driver_error_activity;
CREATE VIEW driver_error_activity AS
SELECT s.name AS scenario, s.id AS scenario_id, m.value AS driver_error,
       sum((SELECT k.value FROM json_each(r.counters) AS k
            WHERE k.key = a.model || '.' || a.counter)) AS acted,
       sum(r.vehicle_h) AS vehicle_h
FROM scenario AS s
JOIN json_each(s.driver_errors) AS e
JOIN json_each(e.value) AS m ON m.key = 'model'
JOIN (SELECT 'failed_to_see' AS model, 'overlooked_pairs' AS counter
      UNION ALL SELECT 'lane_drift', 'drifts' UNION ALL SELECT 'late_braking', 'braked_late'
      UNION ALL SELECT 'misjudged_gap', 'misjudged' UNION ALL SELECT 'red_light', 'red_lights_run'
      UNION ALL SELECT 'risky_overtaking', 'risky_drivers') AS a ON a.model = m.value
JOIN replication AS r ON r.scenario_id = s.id AND r.status = 'done'
JOIN variant AS v ON v.id = r.variant_id AND v.is_baseline
GROUP BY s.id, e.key
ORDER BY s.number, e.key;

-- Replications that did not finish, by scenario and variant. Those that SUMO ended itself are not missing
-- at random: what drivers and functions do leads there.
DROP VIEW IF EXISTS failed_replications;
CREATE VIEW failed_replications AS
SELECT s.name AS scenario, v.name AS variant, v.is_baseline AS is_baseline,
       count(*) AS replications, sum(r.status = 'failed') AS failed,
       (SELECT a.message FROM attempt AS a JOIN replication AS x ON x.id = a.replication_id
        WHERE x.scenario_id = s.id AND x.variant_id = v.id AND x.status = 'failed'
          AND a.message IS NOT NULL ORDER BY a.replication_id, a.number DESC LIMIT 1) AS message
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;

-- Exposure and crash rate of each variant over all its finished replications.
DROP VIEW IF EXISTS crash_rate_by_variant;
CREATE VIEW crash_rate_by_variant AS
SELECT v.name AS variant, v.id AS variant_id, v.is_baseline AS is_baseline,
       count(x.replication_id) AS replications,
       coalesce(sum(x.crashes), 0) AS crashes,
       coalesce(sum(x.frontal_crashes), 0) AS frontal_crashes,
       coalesce(sum(x.vehicle_km), 0.0) AS vehicle_km,
       coalesce(sum(x.vehicle_h), 0.0) AS vehicle_h,
       1e6 * sum(x.crashes) / nullif(sum(x.vehicle_km), 0.0) AS crashes_per_million_km,
       1e6 * sum(x.frontal_crashes) / nullif(sum(x.vehicle_km), 0.0)
           AS frontal_crashes_per_million_km
FROM variant AS v
LEFT JOIN replication_crashes AS x ON x.variant_id = v.id
GROUP BY v.id
ORDER BY v.number;

-- The same for each scenario and variant.
DROP VIEW IF EXISTS crash_rate_by_scenario;
CREATE VIEW crash_rate_by_scenario AS
SELECT s.name AS scenario, v.name AS variant, s.id AS scenario_id, v.id AS variant_id,
       count(x.replication_id) AS replications,
       coalesce(sum(x.crashes), 0) AS crashes,
       coalesce(sum(x.frontal_crashes), 0) AS frontal_crashes,
       coalesce(sum(x.vehicle_km), 0.0) AS vehicle_km,
       coalesce(sum(x.vehicle_h), 0.0) AS vehicle_h,
       1e6 * sum(x.crashes) / nullif(sum(x.vehicle_km), 0.0) AS crashes_per_million_km,
       1e6 * sum(x.frontal_crashes) / nullif(sum(x.vehicle_km), 0.0)
           AS frontal_crashes_per_million_km
FROM scenario AS s CROSS JOIN variant AS v
LEFT JOIN replication_crashes AS x ON x.variant_id = v.id AND x.scenario_id = s.id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;

-- Crashes by variant and type, and how many of each lie inside the validated range.
DROP VIEW IF EXISTS crash_type_by_variant;
CREATE VIEW crash_type_by_variant AS
SELECT v.name AS variant, c.crash_type AS crash_type, count(*) AS crashes,
       sum(c.validity = 'inside') AS inside_validity,
       avg(c.closing_speed_m_s) AS closing_speed_mean_m_s
FROM crash AS c
JOIN replication AS r ON r.id = c.replication_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY v.id, c.crash_type
ORDER BY v.number, c.crash_type;

-- SUMO's own reports of colliding pairs against ours: matched are crashes, explained have a verdict,
-- apart never touched by their outlines: SUMO compares places along a lane, and the nearest the two came
-- stands beside it; unexplained are the rest.
DROP VIEW IF EXISTS sumo_collision_check;
CREATE VIEW sumo_collision_check AS
SELECT s.name AS scenario, v.name AS variant, count(*) AS reported_by_sumo,
       sum(x.found_as = 'crash') AS matched,
       sum(x.found_as NOT IN ('crash', 'no_contact')) AS explained,
       sum(x.found_as = 'no_contact' AND coalesce(x.gap_m, 0.0) > 0.0) AS apart,
       min(x.gap_m) FILTER (WHERE x.found_as = 'no_contact' AND x.gap_m > 0.0) AS apart_min_m,
       max(x.gap_m) FILTER (WHERE x.found_as = 'no_contact' AND x.gap_m > 0.0) AS apart_max_m,
       sum(x.found_as = 'no_contact' AND coalesce(x.gap_m, 0.0) <= 0.0) AS unexplained
FROM sumo_collision AS x
JOIN replication AS r ON r.id = x.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;

-- Contacts that are no crashes, by reason.
DROP VIEW IF EXISTS contact_by_reason;
CREATE VIEW contact_by_reason AS
SELECT s.name AS scenario, v.name AS variant, x.verdict AS reason, count(*) AS contacts,
       count(DISTINCT x.replication_id || ' ' || x.vehicle_1 || ' ' || x.vehicle_2) AS pairs
FROM contact AS x
JOIN replication AS r ON r.id = x.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY s.id, v.id, x.verdict
ORDER BY s.number, v.number, x.verdict;

-- What contacts each scenario's network makes without any driver error or function, by reason; crash:
-- confirmed. Scenarios that start SUMO alike share what was simulated for one of them.
DROP VIEW IF EXISTS background_by_reason;
CREATE VIEW background_by_reason AS
SELECT s.name AS scenario, s.id AS scenario_id, c.reason, c.crash_type, count(*) AS contacts,
       avg(c.closing_speed_m_s) AS closing_speed_mean_m_s
FROM scenario AS s
JOIN scenario AS x ON (x.sumocfg, x.sumo_options, x.files) = (s.sumocfg, s.sumo_options, s.files)
JOIN background_contact AS c ON c.scenario_id = x.id
GROUP BY s.id, c.reason, c.crash_type
ORDER BY s.number, c.reason, c.crash_type;

-- The same in all beside the baseline: background crashes to expect in as many vehicle-km as the
-- baseline has, which are the network's doing, not the drivers'; NULL before it has any.
-- scale_1: the baseline's vehicle-km over those of the background. is_negligible: none, or at most 5 % of
-- the baseline's crashes and of its frontal ones, by the expected numbers (status, compare and report
-- judge by the upper bound of the exact 95 % interval, which SQL cannot tell); NULL when no background
-- was simulated.
DROP VIEW IF EXISTS background_by_scenario;
CREATE VIEW background_by_scenario AS
WITH background AS (
    SELECT s.id AS scenario_id, count(*) AS runs, sum(b.simulated_s) AS simulated_s,
           sum(b.vehicle_km) AS vehicle_km, sum(b.vehicle_h) AS vehicle_h
    FROM scenario AS s
    JOIN scenario AS x ON (x.sumocfg, x.sumo_options, x.files)
                          = (s.sumocfg, s.sumo_options, s.files)
    JOIN background_run AS b ON b.scenario_id = x.id
    GROUP BY s.id
), counted AS (
    SELECT scenario_id, sum(contacts) FILTER (WHERE reason = 'crash') AS crashes,
           sum(contacts) FILTER (WHERE reason = 'crash' AND crash_type LIKE 'front-%')
               AS frontal_crashes,
           sum(contacts) FILTER (WHERE reason <> 'crash') AS other_contacts
    FROM background_by_reason
    GROUP BY scenario_id
), baseline AS (
    SELECT r.scenario_id, sum(r.vehicle_km) AS vehicle_km, sum(r.crashes) AS crashes,
           sum(r.frontal_crashes) AS frontal_crashes
    FROM replication_crashes AS r
    JOIN variant AS v ON v.id = r.variant_id
    WHERE v.is_baseline
    GROUP BY r.scenario_id
), beside AS (
    SELECT s.name AS scenario, s.id AS scenario_id, s.number AS number,
           coalesce(b.runs, 0) AS runs, b.simulated_s, b.vehicle_km, b.vehicle_h,
           CASE WHEN b.runs > 0 THEN coalesce(k.crashes, 0) END AS crashes,
           CASE WHEN b.runs > 0 THEN coalesce(k.frontal_crashes, 0) END AS frontal_crashes,
           CASE WHEN b.runs > 0 THEN coalesce(k.other_contacts, 0) END AS other_contacts,
           coalesce(l.vehicle_km, 0.0) AS baseline_vehicle_km,
           coalesce(l.crashes, 0) AS baseline_crashes,
           coalesce(l.frontal_crashes, 0) AS baseline_frontal_crashes,
           nullif(l.vehicle_km, 0.0) / nullif(b.vehicle_km, 0.0) AS scale_1
    FROM scenario AS s
    LEFT JOIN background AS b ON b.scenario_id = s.id
    LEFT JOIN counted AS k ON k.scenario_id = s.id
    LEFT JOIN baseline AS l ON l.scenario_id = s.id
)
SELECT scenario, scenario_id, runs, simulated_s, vehicle_km, vehicle_h, crashes, frontal_crashes,
       other_contacts, baseline_vehicle_km, baseline_crashes, baseline_frontal_crashes,
       crashes * scale_1 AS expected_crashes, frontal_crashes * scale_1 AS expected_frontal_crashes,
       scale_1,
       CASE WHEN runs > 0 THEN
           crashes = 0 OR coalesce(crashes * scale_1 <= 0.05 * baseline_crashes
                                   AND frontal_crashes * scale_1 <= 0.05 * baseline_frontal_crashes,
                                   0)
       END AS is_negligible
FROM beside
ORDER BY number;

-- How far the study has come.
DROP VIEW IF EXISTS progress;
CREATE VIEW progress AS
SELECT s.name AS scenario, v.name AS variant, count(*) AS replications,
       sum(r.status = 'done') AS done, sum(r.status = 'running') AS running,
       sum(r.status = 'failed') AS failed, sum(r.status = 'planned') AS planned
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;

-- Counterfactual pairs: one row for each crash of the baseline and each treatment, both crashes side
-- by side. replication_id clusters pairs that belong together. *_olc_g are of the frontally struck
-- vehicles the larger value, 0 when left-censored, NULL without one; treated_olc_g is 0 for avoided.
DROP VIEW IF EXISTS counterfactual_pair;
CREATE VIEW counterfactual_pair AS
WITH baseline_olc AS (
    SELECT crash_id, CASE WHEN sum(frontal) > 0
                               AND sum(frontal = 1 AND olc_status = 'simulation_failed') = 0
                          THEN max(CASE WHEN frontal = 1 THEN coalesce(olc_g, 0.0) END) END AS olc_g
    FROM crash_vehicle
    GROUP BY crash_id
), treated_olc AS (
    SELECT crash_id, variant_id,
           CASE WHEN sum(frontal) > 0 AND sum(frontal = 1 AND olc_status = 'simulation_failed') = 0
                THEN max(CASE WHEN frontal = 1 THEN coalesce(olc_g, 0.0) END) END AS olc_g
    FROM counterfactual_vehicle
    GROUP BY crash_id, variant_id
)
SELECT s.name AS scenario, v.name AS variant, r.number AS replication, c.replication_id,
       r.scenario_id, x.variant_id, x.crash_id,
       x.outcome, x.outcome_olc, x.reason, x.detail, x.new_crashes, x.vanished_crashes,
       c.time_s AS baseline_time_s, n.checkpoint_s,
       c.crash_type AS baseline_crash_type, c.validity AS baseline_validity,
       c.closing_speed_m_s AS baseline_closing_speed_m_s,
       b.olc_g AS baseline_olc_g,
       x.time_s AS treated_time_s, x.crash_type AS treated_crash_type,
       x.validity AS treated_validity,
       x.closing_speed_m_s AS treated_closing_speed_m_s,
       CASE WHEN x.outcome = 'avoided' THEN 0.0 ELSE t.olc_g END AS treated_olc_g
FROM counterfactual AS x
JOIN crash AS c ON c.id = x.crash_id
JOIN null_treatment AS n ON n.crash_id = x.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = x.variant_id
LEFT JOIN baseline_olc AS b ON b.crash_id = x.crash_id
LEFT JOIN treated_olc AS t ON t.crash_id = x.crash_id AND t.variant_id = x.variant_id;

-- Outcomes of each treatment in each scenario. crashes are the baseline's confirmed crashes: the
-- outcomes add up to them, by closing speed (here) and by OLC (next view).
DROP VIEW IF EXISTS counterfactual_outcomes;
CREATE VIEW counterfactual_outcomes AS
SELECT s.name AS scenario, v.name AS variant, r.scenario_id, x.variant_id,
       count(*) AS crashes,
       sum(x.outcome = 'invalid') AS invalid,
       sum(x.outcome = 'changed_opponent') AS changed_opponent,
       sum(x.outcome = 'avoided') AS avoided,
       sum(x.outcome = 'mitigated') AS mitigated,
       sum(x.outcome = 'aggravated') AS aggravated,
       sum(x.outcome = 'unchanged') AS unchanged,
       coalesce(sum(x.new_crashes), 0) AS new_crashes,
       -- NULL: not known (of an earlier version)
       sum(x.vanished_crashes) AS vanished_crashes
FROM counterfactual AS x
JOIN crash AS c ON c.id = x.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = x.variant_id
GROUP BY r.scenario_id, x.variant_id
ORDER BY s.number, v.number;

DROP VIEW IF EXISTS counterfactual_outcomes_by_olc;
CREATE VIEW counterfactual_outcomes_by_olc AS
SELECT s.name AS scenario, v.name AS variant, r.scenario_id, x.variant_id,
       count(*) AS crashes,
       sum(x.outcome_olc = 'invalid') AS invalid,
       sum(x.outcome_olc = 'changed_opponent') AS changed_opponent,
       sum(x.outcome_olc = 'avoided') AS avoided,
       sum(x.outcome_olc = 'mitigated') AS mitigated,
       sum(x.outcome_olc = 'aggravated') AS aggravated,
       sum(x.outcome_olc = 'unchanged') AS unchanged,
       sum(x.outcome_olc = 'no_olc') AS no_olc
FROM counterfactual AS x
JOIN crash AS c ON c.id = x.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = x.variant_id
GROUP BY r.scenario_id, x.variant_id
ORDER BY s.number, v.number;

-- Whether the null treatment reproduced the baseline's crashes, by crash type.
DROP VIEW IF EXISTS null_treatment_check;
CREATE VIEW null_treatment_check AS
SELECT s.name AS scenario, c.crash_type, count(*) AS crashes,
       sum(n.status = 'reproduced') AS reproduced,
       sum(n.status IN ('inserted_late', 'no_checkpoint')) AS without_checkpoint,
       sum(n.status IN ('not_reproduced', 'branch_failed', 'checkpoint_lost')) AS failed
FROM null_treatment AS n
JOIN crash AS c ON c.id = n.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
GROUP BY r.scenario_id, c.crash_type
ORDER BY s.number, c.crash_type;

-- Every parameter of every function of every variant, defaults filled in; swept: 1 when the study
-- sweeps it. base is the variant's name without the values of a sweep, so
--   SELECT p.value AS ttc_s, o.olc_median_g FROM olc_by_variant AS o
--   JOIN variant_parameter AS p USING (variant_id) WHERE p.base = 'aeb' AND p.parameter = 'ttc_s'
-- is a curve over the swept parameter.
DROP VIEW IF EXISTS variant_parameter;
CREATE VIEW variant_parameter AS
SELECT v.id AS variant_id, v.name AS variant,
       coalesce((SELECT w.base FROM sweep_value AS w
                 WHERE w.owner = 'variant' AND w.owner_id = v.id LIMIT 1), v.name) AS base,
       f.value ->> 'function' AS function, p.key AS parameter, p.value AS value,
       EXISTS (SELECT 1 FROM sweep_value AS w
               WHERE w.owner = 'variant' AND w.owner_id = v.id
                 AND w.parameter = 'variants.' || w.base || '.' || (f.value ->> 'function') || '.'
                                   || p.key) AS swept
FROM variant AS v, json_each(v.functions) AS f, (
    SELECT w.id AS variant_id, g.key AS function, q.key AS key, q.value AS value, q.id AS place
    FROM variant AS w, json_each(w.functions) AS g, json_each(g.value, '$.parameters') AS q
    UNION ALL
    -- penetration by vehicle type: equipment.TYPE
    SELECT w.id, g.key, 'equipment.' || q.key, q.value, q.id + 1000000
    FROM variant AS w, json_each(w.functions) AS g, json_each(g.value, '$.equipment') AS q
) AS p
WHERE p.variant_id = v.id AND p.function = f.key
ORDER BY v.number, f.key, p.place;

-- The same of the driver errors of every scenario, and its swept options of SUMO (driver_error
-- 'sumo_options').
DROP VIEW IF EXISTS scenario_parameter;
CREATE VIEW scenario_parameter AS
SELECT s.id AS scenario_id, s.name AS scenario,
       coalesce((SELECT w.base FROM sweep_value AS w
                 WHERE w.owner = 'scenario' AND w.owner_id = s.id LIMIT 1), s.name) AS base,
       e.value ->> 'model' AS driver_error, p.key AS parameter, p.value AS value,
       EXISTS (SELECT 1 FROM sweep_value AS w
               WHERE w.owner = 'scenario' AND w.owner_id = s.id
                 AND w.parameter = 'scenarios.' || w.base || '.' || (e.value ->> 'model') || '.'
                                   || p.key) AS swept
FROM scenario AS s, json_each(s.driver_errors) AS e, json_each(e.value, '$.parameters') AS p
UNION ALL
SELECT s.id, s.name, w.base, 'sumo_options',
       substr(w.parameter, length('scenarios.' || w.base || '.sumo_options.') + 1), w.value, 1
FROM sweep_value AS w
JOIN scenario AS s ON s.id = w.owner_id
WHERE w.owner = 'scenario' AND instr(w.parameter, 'scenarios.' || w.base || '.sumo_options.') = 1;

-- One row a secondary crash that goes back to a counted one: the chain of crashes into standing cars
-- down to the first. generation 1 hit a car of the first crash.
DROP VIEW IF EXISTS secondary_crash;
CREATE VIEW secondary_crash AS
WITH RECURSIVE chain (crash_id, at_id, generation) AS (
    SELECT id, follows_crash_id, 1 FROM crash WHERE follows_crash_id IS NOT NULL
    UNION ALL
    SELECT k.crash_id, c.follows_crash_id, k.generation + 1
    FROM chain AS k JOIN crash AS c ON c.id = k.at_id
    WHERE c.follows_crash_id IS NOT NULL
), first_of (crash_id, first_crash_id, generation) AS (
    SELECT crash_id, at_id, max(generation) FROM chain GROUP BY crash_id
)
SELECT s.name AS scenario, v.name AS variant, r.number AS replication,
       c.replication_id, f.crash_id, c.follows_crash_id, f.first_crash_id, f.generation,
       c.time_s, c.time_s - o.time_s AS after_s, c.crash_type, c.closing_speed_m_s, c.validity,
       o.time_s AS first_time_s, o.crash_type AS first_crash_type,
       o.closing_speed_m_s AS first_closing_speed_m_s
FROM first_of AS f
JOIN crash AS c ON c.id = f.crash_id
JOIN crash AS o ON o.id = f.first_crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id;

-- The two cars before each crash (history_s in the study file), with the time to contact: negative
-- before it.
DROP VIEW IF EXISTS pre_crash;
CREATE VIEW pre_crash AS
SELECT s.name AS scenario, v.name AS variant, r.number AS replication, p.crash_id, p.role,
       x.sumo_id, x.at_fault, p.number, p.time_s - c.time_s AS from_contact_s, p.front_x_m,
       p.front_y_m, p.yaw_rad, p.speed_m_s, p.acceleration_m_s2
FROM pre_crash_sample AS p
JOIN crash AS c ON c.id = p.crash_id
JOIN crash_vehicle AS x ON x.crash_id = p.crash_id AND x.role = p.role
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id;

-- Delta-v of every vehicle without rebound, as field data that are reconstructed from crush have it:
-- the change to common velocity. rebound_1: how fast the two cars part along their initial relative
-- velocity, as a share of the closing speed (momentum of both cars; 0 where they slide past each
-- other); delta_v_without_rebound_m_s = delta_v_m_s / (1 + rebound_1). Where no direction is stored
-- (rows of earlier versions) the change of velocity is taken to lie along the relative velocity.
DROP VIEW IF EXISTS delta_v_without_rebound;
CREATE VIEW delta_v_without_rebound AS
WITH parting AS (
    SELECT w.crash_id, w.role, w.variant_id, w.delta_v_m_s,
           (w.delta_v_m_s + o.delta_v_m_s) / c.closing_speed_m_s
           * coalesce((w.delta_v_x_m_s * cos(w.velocity_angle_rad)
                       + w.delta_v_y_m_s * sin(w.velocity_angle_rad)) / nullif(w.delta_v_m_s, 0), 1) - 1
               AS apart_1
    FROM crash_vehicle AS w
    JOIN crash_vehicle AS o ON o.crash_id = w.crash_id AND o.role <> w.role
    JOIN crash AS c ON c.id = w.crash_id
)
SELECT crash_id, role, variant_id, max(0.0, apart_1) AS rebound_1,
       delta_v_m_s / (1 + max(0.0, apart_1)) AS delta_v_without_rebound_m_s
FROM parting;

-- The same of treated crashes of the counterfactual design.
DROP VIEW IF EXISTS counterfactual_delta_v_without_rebound;
CREATE VIEW counterfactual_delta_v_without_rebound AS
WITH parting AS (
    SELECT w.crash_id, w.role, w.variant_id, w.delta_v_m_s,
           (w.delta_v_m_s + o.delta_v_m_s) / x.closing_speed_m_s
           * coalesce((w.delta_v_x_m_s * cos(w.velocity_angle_rad)
                       + w.delta_v_y_m_s * sin(w.velocity_angle_rad)) / nullif(w.delta_v_m_s, 0), 1) - 1
               AS apart_1
    FROM counterfactual_vehicle AS w
    JOIN counterfactual_vehicle AS o
      ON o.crash_id = w.crash_id AND o.variant_id = w.variant_id AND o.role <> w.role
    JOIN counterfactual AS x ON x.crash_id = w.crash_id AND x.variant_id = w.variant_id
)
SELECT crash_id, role, variant_id, max(0.0, apart_1) AS rebound_1,
       delta_v_m_s / (1 + max(0.0, apart_1)) AS delta_v_without_rebound_m_s
FROM parting;
