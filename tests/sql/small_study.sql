-- SPDX-License-Identifier: GPL-3.0-or-later
-- A small invented study for tests: two scenarios, two variants, eight paired seeds, about 150
-- crashes of all kinds, every number from a fixed sequence. No simulation stands behind it.
-- build_small_study.sh runs it on a new database.
PRAGMA foreign_keys = ON;
BEGIN;

-- The question tries to end the script element it is embedded in.
INSERT INTO study (id, name, question, design, seed, replications, duration_s, warmup_s,
                   step_length_s, vehicles, yaml, hash)
VALUES (1, 'invented', 'Does AEB lower the severity? </script><script>document.title = "broken"</script> <b>&amp; more</b>',
        'paired_seeds', 42, 8, 3600, 300, 0.05, '{"default": "mid_size_car", "types": {}}',
        'name: invented' || char(10), 'c0ffee00c0ffee00c0ffee00c0ffee00c0ffee00c0ffee00c0ffee00c0ffee00');
INSERT INTO scenario (id, name, number, sumocfg, sumo_options, files, driver_errors) VALUES
    (11, 'left_turn', 0, 'left_turn.sumocfg', '[]', '{}',
     '[{"model": "failed_to_see", "parameters": {"probability_1": 0.05, "reaction_s": 1.0}}]'),
    (12, 'head_on_overtaking', 1, 'head_on_overtaking.sumocfg', '["--lateral-resolution", "0.8"]',
     '{}', '[{"model": "risky_overtaking", "parameters": {"probability_1": 0.1}}]');
INSERT INTO variant (id, name, number, is_baseline, functions) VALUES
    (21, 'baseline', 0, 1, '[]'),
    (22, 'aeb', 1, 0, '[{"function": "aeb", "parameters": {"ttc_s": 1.2}}]');
INSERT INTO vehicle_model (name, hash, yaml) VALUES
    ('mid_size_car', 'ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12',
     'name: mid_size_car' || char(10));

-- Eight finished replications of every scenario and variant, and one that still waits.
WITH RECURSIVE number(n) AS (SELECT 0 UNION ALL SELECT n + 1 FROM number WHERE n < 7)
INSERT INTO replication (id, scenario_id, variant_id, number, seed, status, configuration_hash,
                         crashpulse_version, sumo_version, sumo_command_line, simulated_s,
                         vehicle_km, vehicle_h, departed, counters)
SELECT 1000 + 100 * s.number + 10 * v.number + n, s.id, v.id, n, 7000 + n, 'done',
       'feed' || printf('%060d', s.number), '0.1.0', '1.15.0', 'sumo -c ' || s.sumocfg, 3300.0,
       180.5 + 3.25 * n + 90 * s.number, 4.5 + 0.1 * n, 400 + n,
       CASE WHEN v.is_baseline THEN '{}' ELSE '{"aeb.activations": ' || (20 + n) || '}' END
FROM scenario AS s CROSS JOIN variant AS v CROSS JOIN number;
INSERT INTO replication (id, scenario_id, variant_id, number, seed, configuration_hash)
VALUES (9999, 12, 22, 8, 7008, 'feed');

-- Uniform numbers from one step of a linear congruence: u1 ... u6 of every crash.
CREATE TEMP TABLE draw AS
WITH RECURSIVE place(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM place WHERE k < 15)
SELECT r.id AS replication_id, r.scenario_id, r.variant_id, k AS number,
       s.number AS scenario, v.number AS variant,
       ((r.id * 7919 + k * 104729 + 11) * 48271 % 2147483647) / 2147483647.0 AS u1,
       ((r.id * 6271 + k * 15485863 + 23) * 69621 % 2147483647) / 2147483647.0 AS u2,
       ((r.id * 9377 + k * 32452843 + 37) * 39373 % 2147483647) / 2147483647.0 AS u3,
       ((r.id * 4243 + k * 49979687 + 53) * 16807 % 2147483647) / 2147483647.0 AS u4
FROM replication AS r JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id CROSS JOIN place
WHERE r.status = 'done'
  AND k < (4 + r.id * 37 % 5 + r.number % 3) / (1 + v.number);

CREATE TEMP TABLE invented AS
SELECT *,
       CASE WHEN u1 < 0.62 - 0.25 * (1 - scenario) THEN 'front-front'
            WHEN u1 < 0.90 THEN 'front-side'
            WHEN u1 < 0.96 THEN 'front-rear' ELSE 'side-side' END AS crash_type,
       (1.0 - 0.3 * variant) * (9.0 + 24.0 * u2) AS closing_speed_m_s,
       1.5 * (u3 - 0.5) + 0.4 * scenario AS lateral_offset_m,
       CASE WHEN scenario = 1 THEN 0.5 * (u4 - 0.5) ELSE -1.7 * u4 + 0.1 END AS angle_rad
FROM draw;

INSERT INTO crash (id, replication_id, number, time_s, x_m, y_m, crash_type, closing_speed_m_s,
                   lateral_offset_m, angle_rad, overlap_1, validity, t_common_s, separation_s, shift_m)
SELECT replication_id * 16384 + number, replication_id, number, 400.0 + 150.25 * number,
       10.0 * u1, 5.0 * u2, crash_type, closing_speed_m_s, lateral_offset_m, angle_rad,
       CASE WHEN crash_type LIKE 'front-%' THEN max(0.0, 1.0 - abs(lateral_offset_m)) END,
       CASE WHEN crash_type <> 'front-front' THEN 'contact_side,opponent_structure'
            WHEN abs(angle_rad) > 0.5236 AND closing_speed_m_s < 14 THEN 'speed,angle'
            WHEN abs(angle_rad) > 0.5236 THEN 'angle'
            WHEN closing_speed_m_s < 14 THEN 'speed' ELSE 'inside' END,
       0.09, 0.14, 0.01
FROM invented;

WITH side(role, place) AS (VALUES ('a', 0), ('b', 1)), vehicle AS (
    SELECT i.*, role, place,
           CASE WHEN role = 'a' AND i.crash_type LIKE 'front-%' THEN 'front'
                WHEN i.crash_type = 'front-front' THEN 'front'
                WHEN i.crash_type = 'front-rear' THEN 'rear' ELSE 'left' END AS contact_side,
           c.validity AS crash_validity
    FROM invented AS i JOIN crash AS c ON c.id = i.replication_id * 16384 + i.number
    CROSS JOIN side
), judged AS (
    SELECT *, CASE WHEN contact_side <> 'front' THEN 'not_front_contact'
                   WHEN closing_speed_m_s < 8.0 THEN 'beyond_0_5_s'
                   WHEN closing_speed_m_s < 8.6 THEN 'no_deceleration'
                   WHEN u4 > 0.985 THEN 'simulation_failed' ELSE 'value' END AS olc_status
    FROM vehicle
)
INSERT INTO crash_vehicle (crash_id, role, scenario_id, variant_id, crash_type, frontal, sumo_id,
    sumo_type, vehicle_model, at_fault, cog_x_m, cog_y_m, yaw_rad, velocity_x_m_s, velocity_y_m_s,
    yaw_rate_rad_s, speed_m_s, length_m, width_m, contact_side, validity, olc_g, olc_status,
    delta_v_m_s, peak_g, mean_g, crush_m)
SELECT replication_id * 16384 + number, role, scenario_id, variant_id, crash_type,
       contact_side = 'front', 'flow.' || (10 * number + place), 'car', 'mid_size_car', role = 'a',
       0.0, 0.0, 0.0, closing_speed_m_s / 2, 0.0, 0.0, closing_speed_m_s / 2, 4.8, 1.8,
       contact_side,
       CASE WHEN crash_type = 'front-front' THEN crash_validity
            WHEN contact_side = 'front' THEN 'opponent_structure'
            ELSE 'contact_side,opponent_structure' END,
       CASE WHEN olc_status = 'value' THEN 0.55 * closing_speed_m_s + 6.0 * u1 + place * 0.8 END,
       olc_status,
       CASE WHEN olc_status <> 'simulation_failed' THEN 0.55 * closing_speed_m_s END,
       CASE WHEN olc_status = 'value' THEN 1.2 * closing_speed_m_s END,
       CASE WHEN olc_status = 'value' THEN 0.6 * closing_speed_m_s END,
       CASE WHEN olc_status = 'value' THEN 0.015 * closing_speed_m_s END
FROM judged;

INSERT INTO contact (replication_id, number, time_s, x_m, y_m, verdict, vehicle_1, vehicle_2)
SELECT id, 0, 512.5, 1.0, 2.0, 'graze', 'flow.1', 'flow.2' FROM replication WHERE number = 3 AND status = 'done';
INSERT INTO sumo_collision (replication_id, number, time_s, collider, victim, sumo_type, found_as)
SELECT replication_id, number, time_s, 'flow.' || 10 * number, 'flow.' || (10 * number + 1),
       'collision', 'crash' FROM crash;

-- How far and where a side or a rear was pushed in.
UPDATE crash_vehicle SET intrusion_m = 0.05 + 0.04 * (crash_id % 7),
    intrusion_zone = CASE contact_side WHEN 'rear' THEN 'rear' ELSE iif(crash_id % 3, 'door', 'rear_wheel') END,
    max_50ms_y_g = 2.0 + crash_id % 5, asi_1 = 0.5 + 0.1 * (crash_id % 4), delta_v_y_m_s = 0.75 * delta_v_m_s
WHERE frontal = 0 AND olc_status <> 'simulation_failed';
-- Who erred, what AEB did, where and how heavy; of the last replication nothing is known.
UPDATE crash_vehicle SET mass_kg = CASE role WHEN 'a' THEN 1500.0 ELSE 1200.0 + 25.0 * (crash_id % 5) END,
       lane = CASE WHEN scenario_id = 11 THEN ':centre_' || (crash_id % 3) || '_0' ELSE 'road_' || (crash_id % 2) END,
       edge = CASE WHEN scenario_id = 11 THEN ':centre_' || (crash_id % 3) ELSE 'road' END,
       junction = CASE WHEN scenario_id = 11 THEN 'centre' END,
       error_count = CASE WHEN role = 'a' THEN crash_id % 4 <> 3 ELSE crash_id % 5 = 0 END
WHERE crash_id / 16384 NOT IN (SELECT id FROM replication WHERE number = 7);
INSERT INTO crash_driver_error
SELECT crash_id, role, 0, CASE scenario_id WHEN 11 THEN 'failed_to_see' ELSE 'risky_overtaking' END,
       CASE WHEN scenario_id = 12 THEN 'everybody' WHEN role = 'b' THEN 'another' ELSE 'opponent' END,
       4.5, 0.25 * (crash_id % 2), NOT (scenario_id = 11 AND role = 'b')
FROM crash_vehicle WHERE error_count = 1;
INSERT INTO crash_function
SELECT crash_id, role, 0, 'aeb', state, NULL, braking_s + 0.2, braking_s, NULL,
       CASE state WHEN 'released' THEN 0.1 END, CASE state WHEN 'braking' THEN 8.0 END,
       braking_s * 0.0 + 8.0, braking_s * 7.5
FROM (SELECT *, CASE WHEN state IN ('braking', 'released') THEN 0.2 + 0.1 * (crash_id % 7) END AS braking_s
      FROM (SELECT *, CASE WHEN role = 'b' THEN 'not_equipped' WHEN crash_id % 3 = 0 THEN 'idle'
                           WHEN crash_id % 7 = 1 THEN 'released' ELSE 'braking' END AS state
            FROM crash_vehicle WHERE variant_id = 22 AND error_count IS NOT NULL));

-- Without driver errors: one network gives a crash, the other only grazes.
INSERT INTO background_run (scenario_id, seed, step_length_s, simulated_s, vehicle_km, vehicle_h,
                            departed, configuration_hash) VALUES
    (11, 7000, 0.05, 3300.0, 185.0, 4.6, 400, 'fade00'),
    (12, 7000, 0.05, 3300.0, 275.0, 4.6, 400, 'fade01');
INSERT INTO background_contact (scenario_id, seed, step_length_s, number, time_s, x_m, y_m, reason,
                                crash_type, closing_speed_m_s, lateral_offset_m, angle_rad,
                                vehicle_1, vehicle_2) VALUES
    (11, 7000, 0.05, 0, 612.5, 1.0, 2.0, 'graze', '', NULL, NULL, NULL, 'flow.1', 'flow.2'),
    (11, 7000, 0.05, 1, 712.5, 1.0, 2.0, 'clipped_waiting', '', NULL, NULL, NULL, 'flow.3', 'flow.4'),
    (11, 7000, 0.05, 2, 812.5, 1.0, 2.0, 'crash', 'front-side', 8.5, 0.4, -1.2, 'flow.5', 'flow.6'),
    (11, 7000, 0.05, 3, 912.5, 1.0, 2.0, 'graze', '', NULL, NULL, NULL, 'flow.7', 'flow.8'),
    (12, 7000, 0.05, 0, 612.5, 1.0, 2.0, 'graze', '', NULL, NULL, NULL, 'flow.1', 'flow.2');

-- The second crash of some replications was into a car of the first.
UPDATE crash SET is_secondary = 1, follows_crash_id = id - 1 WHERE number = 1 AND replication_id IN
    (SELECT id FROM replication WHERE number IN (2, 5));
UPDATE crash SET is_secondary = 1, follows_crash_id = id - 1 WHERE number = 2 AND replication_id IN
    (SELECT id FROM replication WHERE number = 5);
WITH RECURSIVE step(number) AS (VALUES (0) UNION ALL SELECT number + 1 FROM step WHERE number < 3)
INSERT INTO pre_crash_sample
SELECT v.crash_id, v.role, step.number, c.time_s - 0.02 - 0.05 * (3 - step.number),
       v.cog_x_m + 2.0 - v.speed_m_s * (0.02 + 0.05 * (3 - step.number)), v.cog_y_m, v.yaw_rad,
       v.speed_m_s + 0.2 * (3 - step.number), -4.0
FROM crash_vehicle AS v JOIN crash AS c ON c.id = v.crash_id CROSS JOIN step
WHERE c.number = 0;

DROP TABLE temp.draw;
DROP TABLE temp.invented;
COMMIT;
