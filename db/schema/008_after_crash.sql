-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 8: what happens after a crash and before it, and crashes that come from files.

-- The study says how long crashed cars stay and how much of what came before is kept; a fourth
-- design. (SQLite changes a CHECK by a new table only.)
CREATE TABLE study_8 (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    question           TEXT,                     -- what the study asks, in the author's words
    design             TEXT    NOT NULL CHECK (design IN ('paired_seeds', 'independent',
                           'counterfactual', 'assessment')),
    -- assessment: ready collisions from files ('crashpulse assess'), nothing was run
    seed               INTEGER NOT NULL,         -- all randomness of the study follows from it
    replications       INTEGER NOT NULL,         -- planned per scenario and variant; counterfactual:
                                                 -- per scenario, of the baseline
    duration_s         REAL    NOT NULL,         -- simulated time of a replication, warm-up included
    warmup_s           REAL    NOT NULL,         -- crashes and exposure before it are not counted
    step_length_s      REAL    NOT NULL,         -- of the traffic simulation
    vehicles           TEXT    NOT NULL CHECK (json_valid(vehicles)),
    -- {"default": model, "types": {SUMO type: model}}
    yaml               TEXT    NOT NULL,         -- the study file, word for word
    hash               TEXT    NOT NULL,         -- SHA-256 of the study file
    stay_s             REAL    NOT NULL DEFAULT 0, -- crashed cars stand on the road this long; 0:
                                                 -- they leave it at once
    history_s          REAL    NOT NULL DEFAULT 0  -- kept of both cars before a crash
) STRICT;
INSERT INTO study_8 SELECT *, 0.0, 0.0 FROM study;
DROP TABLE study;
ALTER TABLE study_8 RENAME TO study;

-- A secondary crash: one of the two had crashed before and stood on the road. Its state at first
-- contact is that of the standing car; the surrogate has undamaged cars, so validity says 'damaged'.
ALTER TABLE crash ADD COLUMN is_secondary INTEGER NOT NULL DEFAULT 0 CHECK (is_secondary IN (0, 1));
-- That earlier crash (of both cars' the first); NULL for a first crash, and when the earlier one was
-- before warmup_s.
ALTER TABLE crash ADD COLUMN follows_crash_id INTEGER REFERENCES crash (id)
    CHECK (follows_crash_id IS NULL OR (is_secondary = 1 AND follows_crash_id < id));

-- The two cars before a crash, step by step, when the study asks for it (history_s).
CREATE TABLE pre_crash_sample (
    crash_id           INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    number             INTEGER NOT NULL,         -- from 0, one a step, the last ends before contact
    time_s             REAL    NOT NULL,         -- SUMO clock; crash.time_s - time_s before contact
    front_x_m          REAL    NOT NULL,         -- middle of the front bumper, world
    front_y_m          REAL    NOT NULL,
    yaw_rad            REAL    NOT NULL,
    speed_m_s          REAL    NOT NULL,         -- forward
    acceleration_m_s2  REAL    NOT NULL,
    PRIMARY KEY (crash_id, role, number),
    FOREIGN KEY (crash_id, role) REFERENCES crash_vehicle (crash_id, role)
) STRICT, WITHOUT ROWID;
