-- SPDX-License-Identifier: GPL-3.0-or-later
-- A small invented counterfactual study for tests: one baseline of 24 replications in two scenarios,
-- two treatments, every number from a fixed sequence. No simulation stands behind it.
-- build_small_study.sh runs it on a new database.
PRAGMA foreign_keys = ON;
BEGIN;
INSERT INTO study (id, name, question, design, seed, replications, duration_s, warmup_s,
                   step_length_s, vehicles, yaml, hash)
VALUES (1, 'invented_pairs', 'What becomes of the same crashes?', 'counterfactual', 42, 12, 3600,
        300, 0.05, '{"default": "mid_size_car", "types": {}}', 'name: invented_pairs' || char(10),
        'c0ffee01c0ffee01c0ffee01c0ffee01c0ffee01c0ffee01c0ffee01c0ffee01');
INSERT INTO scenario (id, name, number, sumocfg, sumo_options, files, driver_errors) VALUES
    (11, 'left_turn', 0, 'left_turn.sumocfg', '[]', '{}',
     '[{"model": "failed_to_see", "parameters": {"probability_1": 0.05}}]'),
    (12, 'head_on_overtaking', 1, 'head_on_overtaking.sumocfg', '[]', '{}',
     '[{"model": "risky_overtaking", "parameters": {"probability_1": 0.1}}]');
INSERT INTO variant (id, name, number, is_baseline, functions) VALUES
    (21, 'baseline', 0, 1, '[]'),
    (22, 'aeb', 1, 0, '[{"function": "aeb", "parameters": {"ttc_s": 1.2}}]'),
    (23, 'elk', 2, 0, '[{"function": "elk", "parameters": {}}]');
INSERT INTO vehicle_model (name, hash, yaml) VALUES
    ('mid_size_car', 'ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12ab12',
     'name: mid_size_car' || char(10));
WITH RECURSIVE number(n) AS (SELECT 0 UNION ALL SELECT n + 1 FROM number WHERE n < 11)
INSERT INTO replication (id, scenario_id, variant_id, number, seed, status, configuration_hash,
                         crashpulse_version, sumo_version, simulated_s, vehicle_km, vehicle_h,
                         departed, counters)
SELECT 1000 + 100 * s.number + n, s.id, 21, n, 7000 + n, 'done', 'feed' || printf('%060d', s.number),
       '0.1.0', '1.15.0', 3300.0, 180.5 + 3.25 * n + 90 * s.number, 4.5 + 0.1 * n, 400 + n, '{}'
FROM scenario AS s CROSS JOIN number;

CREATE TEMP TABLE invented AS
WITH RECURSIVE place(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM place WHERE k < 8)
SELECT r.id * 16384 + k AS id, r.id AS replication_id, r.scenario_id, k AS number,
       ((r.id * 7919 + k * 104729 + 11) * 48271 % 2147483647) / 2147483647.0 AS u1,
       9.0 + 24.0 * (((r.id * 6271 + k * 15485863 + 23) * 69621 % 2147483647) / 2147483647.0)
           AS closing_speed_m_s
FROM replication AS r CROSS JOIN place
WHERE k < 3 + r.id * 37 % 5;
INSERT INTO crash (id, replication_id, number, time_s, x_m, y_m, crash_type, closing_speed_m_s,
                   lateral_offset_m, angle_rad, overlap_1, validity, shift_m)
SELECT id, replication_id, number, 400.0 + 150.25 * number, 100.0 * u1, 5.0,
       CASE WHEN u1 < 0.7 THEN 'front-front' WHEN u1 < 0.95 THEN 'front-side' ELSE 'side-side' END,
       closing_speed_m_s, u1 - 0.5, 0.2 * (u1 - 0.5), CASE WHEN u1 < 0.95 THEN 0.8 END,
       CASE WHEN u1 < 0.7 THEN 'inside' ELSE 'opponent_structure' END, 0.01
FROM invented;

-- Both vehicles: OLC 0.9 times the closing speed, delta-v 0.55 times.
CREATE TEMP TABLE vehicle AS
SELECT c.*, i.scenario_id, role,
       CASE WHEN c.crash_type = 'front-front' OR (c.crash_type = 'front-side' AND role = 'a')
            THEN 'front' ELSE 'left' END AS contact_side
FROM crash AS c JOIN invented AS i USING (id) CROSS JOIN (SELECT 'a' AS role UNION SELECT 'b');
INSERT INTO crash_vehicle (crash_id, role, scenario_id, variant_id, crash_type, frontal, sumo_id,
    sumo_type, vehicle_model, at_fault, cog_x_m, cog_y_m, yaw_rad, velocity_x_m_s, velocity_y_m_s,
    yaw_rate_rad_s, speed_m_s, length_m, width_m, contact_side, validity, olc_g, olc_status,
    delta_v_m_s)
SELECT id, role, scenario_id, 21, crash_type, contact_side = 'front', 'flow.' || number || role,
       'car', 'mid_size_car', role = 'a', 0.0, 0.0, 0.0, closing_speed_m_s / 2, 0.0, 0.0,
       closing_speed_m_s / 2, 4.8, 1.8, contact_side, validity,
       CASE WHEN contact_side = 'front' THEN 0.9 * closing_speed_m_s END,
       CASE WHEN contact_side = 'front' THEN 'value' ELSE 'not_front_contact' END,
       0.55 * closing_speed_m_s
FROM vehicle;

-- Outcomes: 5 % without a checkpoint, then 40 (elk: 20) % avoided, and so on.
CREATE TEMP TABLE outcome AS
WITH draw AS (
    SELECT c.*, v.id AS variant_id, v.number AS treatment,
           (((c.replication_id * 1048576 + c.number) % 99991 * 15485863 + v.id * 32452843) % 2147483647) / 2147483647.0 AS u,
           (((c.replication_id * 1048576 + c.number) % 99991 * 49979687) % 2147483647) / 2147483647.0 AS w
    FROM crash AS c CROSS JOIN variant AS v WHERE v.is_baseline = 0
)
SELECT *, CASE WHEN w < 0.05 THEN 'invalid'
               WHEN u < 0.6 - 0.2 * treatment THEN 'avoided'
               WHEN u < 0.75 THEN 'mitigated' WHEN u < 0.9 THEN 'unchanged'
               WHEN u < 0.95 THEN 'aggravated' ELSE 'changed_opponent' END AS outcome
FROM draw;
CREATE TEMP TABLE treated AS
SELECT *, closing_speed_m_s * CASE outcome WHEN 'mitigated' THEN 0.6 WHEN 'aggravated' THEN 1.1
                              WHEN 'changed_opponent' THEN 0.8 ELSE 1.0 END AS closing
FROM outcome;
INSERT INTO null_treatment (crash_id, status, lead_s, checkpoint_s)
SELECT DISTINCT id, CASE WHEN outcome = 'invalid' THEN 'no_checkpoint' ELSE 'reproduced' END, 4.0,
       CASE WHEN outcome <> 'invalid' THEN time_s - 5.0 END FROM treated;
INSERT INTO counterfactual (crash_id, variant_id, outcome, outcome_olc, reason, new_crashes, vanished_crashes, time_s,
                            x_m, y_m, crash_type, closing_speed_m_s, lateral_offset_m, angle_rad,
                            validity)
SELECT id, variant_id, outcome,
       CASE WHEN outcome IN ('invalid', 'avoided', 'changed_opponent') THEN outcome
            WHEN crash_type NOT LIKE 'front-%' THEN 'no_olc' ELSE outcome END,
       CASE WHEN outcome = 'invalid' THEN 'no_checkpoint' END,
       CASE WHEN outcome <> 'invalid' THEN number % 7 = 6 END,
       CASE WHEN outcome <> 'invalid' THEN number % 5 = 4 END,
       iif(outcome IN ('invalid', 'avoided'), NULL, time_s),
       iif(outcome IN ('invalid', 'avoided'), NULL, x_m),
       iif(outcome IN ('invalid', 'avoided'), NULL, y_m),
       iif(outcome IN ('invalid', 'avoided'), NULL, crash_type),
       iif(outcome IN ('invalid', 'avoided'), NULL, closing),
       iif(outcome IN ('invalid', 'avoided'), NULL, lateral_offset_m),
       iif(outcome IN ('invalid', 'avoided'), NULL, angle_rad),
       iif(outcome IN ('invalid', 'avoided'), NULL, validity)
FROM treated;
INSERT INTO counterfactual_vehicle (crash_id, variant_id, role, frontal, sumo_id, sumo_type,
    vehicle_model, at_fault, cog_x_m, cog_y_m, yaw_rad, velocity_x_m_s, velocity_y_m_s,
    yaw_rate_rad_s, speed_m_s, length_m, width_m, contact_side, validity, olc_g, olc_status,
    delta_v_m_s)
SELECT t.id, t.variant_id, w.role, w.frontal, w.sumo_id, w.sumo_type, w.vehicle_model, w.at_fault,
       0.0, 0.0, 0.0, t.closing / 2, 0.0, 0.0, t.closing / 2, 4.8, 1.8, w.contact_side, w.validity,
       CASE WHEN w.frontal THEN 0.9 * t.closing END, w.olc_status, 0.55 * t.closing
FROM treated AS t JOIN crash_vehicle AS w ON w.crash_id = t.id
WHERE t.outcome NOT IN ('invalid', 'avoided');
DROP TABLE temp.invented;
DROP TABLE temp.vehicle;
DROP TABLE temp.outcome;
DROP TABLE temp.treated;
COMMIT;
