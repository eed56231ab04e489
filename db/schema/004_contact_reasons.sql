-- SPDX-License-Identifier: GPL-3.0-or-later
-- More reasons why a contact of two rectangles is no crash; a pair that has parted may come again.

DROP VIEW IF EXISTS sumo_collision_check;

-- Contacts of two rectangles that are not counted as crashes, and why not. One row a contact: a
-- pair that touches, parts (0.1 m) and touches again has two.
CREATE TABLE contact_2 (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of time
    time_s             REAL    NOT NULL,         -- SUMO clock of first touch
    x_m                REAL    NOT NULL,         -- first contact point, world
    y_m                REAL    NOT NULL,
    verdict            TEXT    NOT NULL CHECK (verdict IN ('graze', 'overlap_at_insertion',
                           'lane_change_jump', 'impossible_motion', 'clipped_waiting',
                           'no_common_road', 'other_level', 'long_vehicle_turning', 'after_crash',
                           'warmup')),
    -- graze: their motion at first touch leads to no deep overlap
    -- overlap_at_insertion: SUMO put one on top of the other (insertion, teleport)
    -- lane_change_jump: SUMO moved one sideways onto the other within a step
    -- impossible_motion: one slides or turns as no vehicle can (kinks of SUMO's lanes)
    -- clipped_waiting: a corner of a car that stands, less than half a width, lies in the way of
    --   the other, and no driver error is at work on either
    -- no_common_road: their roads cross or run side by side without meeting
    -- other_level: one passes over the other
    -- long_vehicle_turning: only the trailing part of a long vehicle is touched while it turns
    -- after_crash: one of them had crashed with a third in the same step
    -- warmup: would be a crash, but before warmup_s
    vehicle_1          TEXT    NOT NULL,         -- SUMO ids, in order of role
    vehicle_2          TEXT    NOT NULL,
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;
INSERT INTO contact_2 SELECT * FROM contact;
DROP TABLE contact;
ALTER TABLE contact_2 RENAME TO contact;

-- Cross-check: every pair of vehicles that SUMO itself reported as colliding, once, and what we
-- made of it.
CREATE TABLE sumo_collision_2 (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of SUMO's first report
    time_s             REAL    NOT NULL,         -- end of the step of SUMO's first report
    collider           TEXT    NOT NULL,         -- SUMO ids
    victim             TEXT    NOT NULL,
    sumo_type          TEXT    NOT NULL,         -- SUMO's word: collision, frontal, junction
    found_as           TEXT    NOT NULL CHECK (found_as IN ('crash', 'graze',
                           'overlap_at_insertion', 'lane_change_jump', 'impossible_motion',
                           'clipped_waiting', 'no_common_road', 'other_level', 'long_vehicle_turning',
                           'after_crash', 'warmup', 'no_contact')),
    -- crash: confirmed by us; no_contact: the rectangles never touched; else the verdict on the
    -- contact nearest in time
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;
INSERT INTO sumo_collision_2 SELECT * FROM sumo_collision;
DROP TABLE sumo_collision;
ALTER TABLE sumo_collision_2 RENAME TO sumo_collision;
