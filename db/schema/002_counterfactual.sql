-- SPDX-License-Identifier: GPL-3.0-or-later
-- Design counterfactual: every crash of a baseline replication is run again from a checkpoint before
-- its contact, once without any treatment and once with each treatment on its two vehicles. Only the
-- baseline has replications then; the treatments are the other variants.

-- The study may have the third design. (SQLite changes a CHECK by a new table only.)
CREATE TABLE study_of_three_designs (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    question           TEXT,                     -- what the study asks, in the author's words
    design             TEXT    NOT NULL
                       CHECK (design IN ('paired_seeds', 'independent', 'counterfactual')),
    seed               INTEGER NOT NULL,         -- all randomness of the study follows from it
    replications       INTEGER NOT NULL,         -- planned per scenario and variant; counterfactual:
                                                 -- per scenario, of the baseline
    duration_s         REAL    NOT NULL,         -- simulated time of a replication, warm-up included
    warmup_s           REAL    NOT NULL,         -- crashes and exposure before it are not counted
    step_length_s      REAL    NOT NULL,         -- of the traffic simulation
    vehicles           TEXT    NOT NULL CHECK (json_valid(vehicles)),
    -- {"default": model, "types": {SUMO type: model}}
    yaml               TEXT    NOT NULL,         -- the study file, word for word
    hash               TEXT    NOT NULL          -- SHA-256 of the study file
) STRICT;
INSERT INTO study_of_three_designs SELECT * FROM study;
DROP TABLE study;
ALTER TABLE study_of_three_designs RENAME TO study;

-- The null treatment: the same crash again from its checkpoint with nothing changed. One row for
-- every crash of a baseline replication. Anything but 'reproduced' makes the crash invalid under
-- every treatment.
CREATE TABLE null_treatment (
    crash_id           INTEGER PRIMARY KEY REFERENCES crash (id),
    status             TEXT    NOT NULL CHECK (status IN ('reproduced', 'inserted_late',
                           'no_checkpoint', 'checkpoint_lost', 'branch_failed', 'not_reproduced')),
    -- reproduced: same vehicles, time, states at first contact and pulses, bit for bit.
    -- inserted_late: one of the two entered the road less than lead_s before contact.
    -- no_checkpoint: none is old enough; the replication had just begun or the driver error is older
    -- than the oldest checkpoint kept. checkpoint_lost: its process had ended. branch_failed: the
    -- branch ended without an answer (SUMO aborted, out of time). not_reproduced: another outcome.
    lead_s             REAL    NOT NULL,         -- the checkpoint had to be this long before contact:
                                                 -- 4 s, or 1 s before the driver error began
    checkpoint_s       REAL,                     -- SUMO clock of the checkpoint; NULL without one
    detail             TEXT                      -- what differs, how the branch ended
) STRICT;

-- One crash of the baseline under one treatment: exactly one row for each, its outcome the first of
-- this list that holds.
CREATE TABLE counterfactual (
    crash_id           INTEGER NOT NULL REFERENCES crash (id),   -- the baseline's crash
    variant_id         INTEGER NOT NULL REFERENCES variant (id), -- the treatment
    outcome            TEXT    NOT NULL CHECK (outcome IN ('invalid', 'changed_opponent', 'avoided',
                           'mitigated', 'aggravated', 'unchanged')),
    -- invalid: see reason. changed_opponent: the first confirmed crash of one of the two is with a
    -- third. avoided: no confirmed crash of the two until 10 s after the baseline's contact.
    -- mitigated, aggravated: closing speed lower, higher by more than 0.5 m/s; else unchanged
    outcome_olc        TEXT    NOT NULL CHECK (outcome_olc IN ('invalid', 'changed_opponent',
                           'avoided', 'mitigated', 'aggravated', 'unchanged', 'no_olc')),
    -- the same by OLC, more than 0.5 g: of the frontally struck vehicles the larger value; left-
    -- censored ones count as 0. no_olc: one of the two crashes has no frontally struck vehicle, or
    -- could not be simulated
    reason             TEXT    CHECK (reason IN ('inserted_late', 'no_checkpoint',
                           'checkpoint_lost', 'branch_failed', 'not_reproduced')),
    -- why invalid, as in null_treatment; branch_failed also when this treatment's branch failed
    detail             TEXT,                     -- in words
    new_crashes        INTEGER,                  -- confirmed crashes between others, from the
                                                 -- checkpoint to the horizon, that the baseline does
                                                 -- not have; NULL when invalid
    -- from here on the treated crash at first contact, NULL unless there is one; columns as in crash
    time_s             REAL,
    x_m                REAL,
    y_m                REAL,
    crash_type         TEXT    CHECK (crash_type IN ('front-front', 'front-side', 'front-rear',
                           'side-side', 'side-rear', 'rear-rear')),
    closing_speed_m_s  REAL,
    lateral_offset_m   REAL,
    angle_rad          REAL,
    overlap_1          REAL,
    validity           TEXT,
    t_common_s         REAL,
    separation_s       REAL,
    shift_m            REAL,
    PRIMARY KEY (crash_id, variant_id),
    CHECK ((outcome = 'invalid') = (reason IS NOT NULL)),
    CHECK ((outcome = 'invalid') = (new_crashes IS NULL)),
    CHECK ((outcome IN ('invalid', 'avoided')) = (time_s IS NULL)),
    CHECK ((time_s IS NULL) = (closing_speed_m_s IS NULL)),
    CHECK (CASE WHEN outcome IN ('invalid', 'changed_opponent', 'avoided')
                THEN outcome_olc = outcome
                ELSE outcome_olc NOT IN ('invalid', 'changed_opponent', 'avoided') END)
) STRICT, WITHOUT ROWID;
CREATE INDEX counterfactual_variant ON counterfactual (variant_id, outcome);

-- One vehicle of a treated crash; columns as in crash_vehicle. A vehicle keeps the role it has in
-- the baseline's crash; a third one has the other.
CREATE TABLE counterfactual_vehicle (
    crash_id           INTEGER NOT NULL,
    variant_id         INTEGER NOT NULL,
    role               TEXT    NOT NULL CHECK (role IN ('a', 'b')),
    frontal            INTEGER NOT NULL CHECK (frontal = (contact_side = 'front')),
    sumo_id            TEXT    NOT NULL,
    sumo_type          TEXT    NOT NULL,
    vehicle_model      TEXT    NOT NULL REFERENCES vehicle_model (name),
    at_fault           INTEGER NOT NULL CHECK (at_fault IN (0, 1)),
    cog_x_m            REAL    NOT NULL,
    cog_y_m            REAL    NOT NULL,
    yaw_rad            REAL    NOT NULL,
    velocity_x_m_s     REAL    NOT NULL,
    velocity_y_m_s     REAL    NOT NULL,
    yaw_rate_rad_s     REAL    NOT NULL,
    speed_m_s          REAL    NOT NULL,
    length_m           REAL    NOT NULL,
    width_m            REAL    NOT NULL,
    velocity_angle_rad REAL,
    contact_side       TEXT    NOT NULL CHECK (contact_side IN ('front', 'left', 'right', 'rear')),
    validity           TEXT    NOT NULL,
    olc_g              REAL,
    olc_status         TEXT    NOT NULL CHECK (olc_status IN ('value', 'not_front_contact',
                           'no_deceleration', 'beyond_0_5_s', 'simulation_failed')),
    olc_t1_s           REAL,
    olc_t2_s           REAL,
    delta_v_m_s        REAL,
    delta_v_x_m_s      REAL,
    delta_v_y_m_s      REAL,
    peak_g             REAL,
    mean_g             REAL,
    t_v0_s             REAL,
    max_50ms_g         REAL,
    asi_1              REAL,
    pdof_rad           REAL,
    yaw_change_rad_s   REAL,
    crush_m            REAL,
    end_s              REAL,
    PRIMARY KEY (crash_id, variant_id, role),
    FOREIGN KEY (crash_id, variant_id) REFERENCES counterfactual (crash_id, variant_id),
    CHECK ((olc_g IS NOT NULL) = (olc_status = 'value')),
    CHECK (frontal = 0 OR olc_status <> 'not_front_contact')
) STRICT, WITHOUT ROWID;

-- Pulses of treated crashes, packed as in pulse.
CREATE TABLE counterfactual_pulse (
    crash_id           INTEGER NOT NULL,
    variant_id         INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    codec              INTEGER NOT NULL,
    sample_interval_s  REAL    NOT NULL,
    sample_count       INTEGER NOT NULL,
    samples            BLOB    NOT NULL,
    PRIMARY KEY (crash_id, variant_id, role),
    FOREIGN KEY (crash_id, variant_id, role)
        REFERENCES counterfactual_vehicle (crash_id, variant_id, role)
) STRICT, WITHOUT ROWID;

-- The two vehicles before a crash or an avoidance, step by step, when the study asks for it
-- (counterfactual.time_series_s). The null treatment's rows have the baseline's variant_id.
CREATE TABLE counterfactual_sample (
    crash_id           INTEGER NOT NULL REFERENCES crash (id),
    variant_id         INTEGER NOT NULL REFERENCES variant (id),
    role               TEXT    NOT NULL CHECK (role IN ('a', 'b')), -- as in the baseline's crash
    number             INTEGER NOT NULL,         -- from 0, one a step
    time_s             REAL    NOT NULL,         -- SUMO clock
    front_x_m          REAL    NOT NULL,         -- middle of the front bumper, world
    front_y_m          REAL    NOT NULL,
    yaw_rad            REAL    NOT NULL,
    speed_m_s          REAL    NOT NULL,
    acceleration_m_s2  REAL    NOT NULL,
    ttc_s              REAL,                     -- of the two vehicles, constant turn; NULL beyond 10 s
    brake_request_m_s2 REAL    NOT NULL,         -- deceleration asked for by the functions, 0 if none
    PRIMARY KEY (crash_id, variant_id, role, number)
) STRICT, WITHOUT ROWID;
