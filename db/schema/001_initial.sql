-- SPDX-License-Identifier: GPL-3.0-or-later
-- The database of one study. SI units, unit in every column name, frames as in the README: world x
-- east, y north; headings counter-clockwise from east, rad; vehicle axes x forward, y left.
--
-- Row ids come from natural keys (first 42 bits of a SHA-256), so that a study run again, run in
-- another order or merged from parts gives the same rows. Time stamps, hosts and process ids are in
-- the table attempt only; leave it out to compare two databases.

-- The study file as it was run. One row.
CREATE TABLE study (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    question           TEXT,                     -- what the study asks, in the author's words
    design             TEXT    NOT NULL CHECK (design IN ('paired_seeds', 'independent')),
    seed               INTEGER NOT NULL,         -- all randomness of the study follows from it
    replications       INTEGER NOT NULL,         -- planned per scenario and variant
    duration_s         REAL    NOT NULL,         -- simulated time of a replication, warm-up included
    warmup_s           REAL    NOT NULL,         -- crashes and exposure before it are not counted
    step_length_s      REAL    NOT NULL,         -- of the traffic simulation
    vehicles           TEXT    NOT NULL CHECK (json_valid(vehicles)),
    -- {"default": vehicle model, "types": {SUMO vehicle type: vehicle model}}
    yaml               TEXT    NOT NULL,         -- the study file, word for word
    hash               TEXT    NOT NULL          -- SHA-256 of the study file
) STRICT;

-- A traffic situation with the errors its drivers make.
CREATE TABLE scenario (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    number             INTEGER NOT NULL,         -- place in the study file, from 0
    sumocfg            TEXT    NOT NULL,         -- as written in the study file
    sumo_options       TEXT    NOT NULL CHECK (json_valid(sumo_options)), -- array of words
    files              TEXT    NOT NULL CHECK (json_valid(files)),
    -- {file: SHA-256} of the sumocfg and of the networks, routes and additional files it names, XML
    -- comments left out (netconvert writes the date into one)
    driver_errors      TEXT    NOT NULL CHECK (json_valid(driver_errors))
    -- array of {"model": …, "parameters": {name: value}}, defaults filled in: the assumption every
    -- rate depends on
) STRICT;

-- What is compared: a set of driver assistance functions.
CREATE TABLE variant (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    number             INTEGER NOT NULL,         -- place in the study file, from 0
    is_baseline        INTEGER NOT NULL CHECK (is_baseline IN (0, 1)),
    functions          TEXT    NOT NULL CHECK (json_valid(functions))
    -- array of {"function": …, "parameters": {name: value}}, defaults filled in
) STRICT;

-- One run of the traffic simulation: the queue of work and, when done, its exposure. Its crashes,
-- contacts and pulses are written together with the status done, in one transaction.
CREATE TABLE replication (
    id                 INTEGER PRIMARY KEY,      -- from "scenario|variant|sweep|seed"
    scenario_id        INTEGER NOT NULL REFERENCES scenario (id),
    variant_id         INTEGER NOT NULL REFERENCES variant (id),
    sweep              TEXT    NOT NULL DEFAULT '', -- sweep point; empty without a sweep
    number             INTEGER NOT NULL,         -- from 0; paired seeds: the same number shares the seed
    seed               INTEGER NOT NULL,         -- of SUMO and of our own draws
    status             TEXT    NOT NULL DEFAULT 'planned'
                       CHECK (status IN ('planned', 'running', 'done', 'failed')),
    configuration_hash TEXT    NOT NULL,         -- SHA-256 of everything the outcome depends on
    -- from here on NULL until the status is done
    crashpulse_version TEXT,
    sumo_version       TEXT,
    sumo_command_line  TEXT,                     -- all SUMO options of the run, ours included
    simulated_s        REAL,                     -- counted time: without warm-up
    vehicle_km         REAL,                     -- driven by all vehicles in that time
    vehicle_h          REAL,                     -- spent on the road by all vehicles in that time
    departed           INTEGER,                  -- vehicles inserted in that time
    counters           TEXT    CHECK (counters IS NULL OR json_valid(counters)),
    -- what drivers and functions did: {"aeb.activations": 12, …}
    UNIQUE (scenario_id, variant_id, sweep, seed)
) STRICT;
CREATE INDEX replication_status ON replication (status);
CREATE INDEX replication_variant ON replication (variant_id, scenario_id, number);

-- Who worked on a replication, when and with what outcome.
CREATE TABLE attempt (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 1
    host               TEXT    NOT NULL,
    pid                INTEGER NOT NULL,
    process_start      INTEGER NOT NULL,         -- start of that process, clock ticks since boot:
                                                 -- tells it from a later process with the same pid
    started            TEXT    NOT NULL,         -- UTC, ISO 8601
    wall_time_s        REAL,                     -- NULL while running
    outcome            TEXT    NOT NULL
                       CHECK (outcome IN ('running', 'done', 'failed', 'lost', 'interrupted')),
    message            TEXT,                     -- why it failed: SUMO's last words
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;

-- A car of the multibody surrogate, as it was used.
CREATE TABLE vehicle_model (
    name               TEXT    PRIMARY KEY,
    hash               TEXT    NOT NULL,         -- SHA-256 of the vehicle file
    yaml               TEXT    NOT NULL          -- the vehicle file, word for word
) STRICT, WITHOUT ROWID;

-- A confirmed crash of two vehicles at the instant of first contact. Roles: a is a vehicle whose
-- front is struck; if that holds for both or neither, the one with the driver error, else the one
-- with the smaller SUMO id.
CREATE TABLE crash (
    id                 INTEGER PRIMARY KEY,      -- replication_id * 2^20 + number
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of time_s, then SUMO ids
    time_s             REAL    NOT NULL,         -- SUMO clock, inside a step
    x_m                REAL    NOT NULL,         -- first contact point, world
    y_m                REAL    NOT NULL,
    crash_type         TEXT    NOT NULL CHECK (crash_type IN ('front-front', 'front-side',
                           'front-rear', 'side-side', 'side-rear', 'rear-rear')),
    closing_speed_m_s  REAL    NOT NULL,         -- relative speed of the bodies at the contact point
    lateral_offset_m   REAL    NOT NULL,         -- middle of b's front edge in a's frame, y
    angle_rad          REAL    NOT NULL,         -- wrap(yaw_b - yaw_a - pi): 0 exactly oncoming
    overlap_1          REAL,                     -- share of a's width covered by b; NULL unless a's
                                                 -- front is struck
    validity           TEXT    NOT NULL,         -- 'inside' when it is for both vehicles, else the
                                                 -- list of what is outside for either
    t_common_s         REAL,                     -- relative velocity first zero along its initial
                                                 -- direction, from first contact
    separation_s       REAL,                     -- last contact force, from first contact
    shift_m            REAL,                     -- the model outlines were moved this far along the
                                                 -- relative velocity until they just touched
    UNIQUE (replication_id, number),
    CHECK (id = replication_id * 1048576 + number AND number BETWEEN 0 AND 1048575)
) STRICT;

-- One vehicle of a crash: its state at first contact and what the crash did to it. OLC and the
-- other pulse measures: see README, "What the numbers mean".
CREATE TABLE crash_vehicle (
    crash_id           INTEGER NOT NULL REFERENCES crash (id),
    role               TEXT    NOT NULL CHECK (role IN ('a', 'b')),
    scenario_id        INTEGER NOT NULL,         -- copies of the crash's, so that distributions
    variant_id         INTEGER NOT NULL,         -- need no join; kept true by a trigger
    crash_type         TEXT    NOT NULL,
    frontal            INTEGER NOT NULL CHECK (frontal = (contact_side = 'front')),
                                                 -- 1: struck on its front, the unit of OLC
                                                 -- distributions
    sumo_id            TEXT    NOT NULL,
    sumo_type          TEXT    NOT NULL,
    vehicle_model      TEXT    NOT NULL REFERENCES vehicle_model (name),
    at_fault           INTEGER NOT NULL CHECK (at_fault IN (0, 1)), -- a driver error was active on it
    cog_x_m            REAL    NOT NULL,         -- centre of gravity at first contact, world
    cog_y_m            REAL    NOT NULL,
    yaw_rad            REAL    NOT NULL,
    velocity_x_m_s     REAL    NOT NULL,         -- of the centre of gravity, world
    velocity_y_m_s     REAL    NOT NULL,
    yaw_rate_rad_s     REAL    NOT NULL,
    speed_m_s          REAL    NOT NULL,         -- forward speed
    length_m           REAL    NOT NULL,         -- of its SUMO rectangle
    width_m            REAL    NOT NULL,
    velocity_angle_rad REAL,                     -- relative velocity against its own x axis,
                                                 -- 0 straight ahead
    contact_side       TEXT    NOT NULL CHECK (contact_side IN ('front', 'left', 'right', 'rear')),
    validity           TEXT    NOT NULL,         -- 'inside', or what is outside the calibrated range:
                                                 -- 'speed,angle'
    olc_g              REAL,                     -- occupant load criterion; NULL unless olc_status is
                                                 -- 'value'
    olc_status         TEXT    NOT NULL CHECK (olc_status IN ('value', 'not_front_contact',
                           'no_deceleration', 'beyond_0_5_s', 'simulation_failed')),
                                                 -- no_deceleration and beyond_0_5_s are left-censored:
                                                 -- they count below every value
    olc_t1_s           REAL,                     -- free flight of 65 mm ends
    olc_t2_s           REAL,                     -- 300 mm used up
    delta_v_m_s        REAL,                     -- magnitude of the change of velocity
    delta_v_x_m_s      REAL,                     -- v_x at first contact minus at the end
    delta_v_y_m_s      REAL,
    peak_g             REAL,                     -- largest deceleration along x, CFC60
    mean_g             REAL,                     -- mean deceleration until the lowest v_x
    t_v0_s             REAL,                     -- first v_x <= 0; against a barrier only, else NULL
    max_50ms_g         REAL,                     -- largest 50 ms moving mean deceleration along x
    asi_1              REAL,                     -- acceleration severity index
    pdof_rad           REAL,                     -- principal direction of force, vehicle axes
    yaw_change_rad_s   REAL,                     -- yaw rate at the end minus at first contact
    crush_m            REAL,                     -- largest dynamic shortening of the front
    end_s              REAL,                     -- end of the crash: separation or, if later, the
                                                 -- time of the largest change of velocity
    PRIMARY KEY (crash_id, role),
    CHECK ((olc_g IS NOT NULL) = (olc_status = 'value')),
    CHECK (frontal = 0 OR olc_status <> 'not_front_contact')
) STRICT, WITHOUT ROWID;
CREATE INDEX crash_vehicle_variant ON crash_vehicle (variant_id, role, olc_g);
-- The distribution of OLC in order: NULL (left-censored) sorts first.
CREATE INDEX crash_vehicle_olc ON crash_vehicle (variant_id, olc_g)
    WHERE olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s');

CREATE TRIGGER crash_vehicle_copies BEFORE INSERT ON crash_vehicle
WHEN NOT EXISTS (
    SELECT 1 FROM crash AS c JOIN replication AS r ON r.id = c.replication_id
    WHERE c.id = NEW.crash_id AND c.crash_type = NEW.crash_type
      AND r.scenario_id = NEW.scenario_id AND r.variant_id = NEW.variant_id)
BEGIN
    SELECT RAISE(ABORT, 'crash_vehicle: scenario_id, variant_id or crash_type is not its crash''s');
END;
CREATE TRIGGER crash_vehicle_copies_stay
BEFORE UPDATE OF crash_id, scenario_id, variant_id, crash_type ON crash_vehicle
BEGIN
    SELECT RAISE(ABORT, 'crash_vehicle: crash_id, scenario_id, variant_id and crash_type are fixed');
END;
CREATE TRIGGER crash_stays BEFORE UPDATE OF id, replication_id, crash_type ON crash
BEGIN
    SELECT RAISE(ABORT, 'crash: id, replication_id and crash_type are fixed');
END;
CREATE TRIGGER replication_stays BEFORE UPDATE OF id, scenario_id, variant_id, sweep, seed ON replication
BEGIN
    SELECT RAISE(ABORT, 'replication: id, scenario_id, variant_id, sweep and seed are fixed');
END;

-- Contacts of two rectangles that are not counted as crashes, and why not.
CREATE TABLE contact (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of time
    time_s             REAL    NOT NULL,         -- SUMO clock of first touch
    x_m                REAL    NOT NULL,         -- first contact point, world
    y_m                REAL    NOT NULL,
    verdict            TEXT    NOT NULL CHECK (verdict IN ('graze', 'overlap_at_insertion',
                           'no_common_road', 'after_crash', 'warmup')),
    -- graze: their motion at first touch leads to no deep overlap; overlap_at_insertion: SUMO put
    -- one on top of the other; no_common_road: different levels or roads; after_crash: one of them
    -- had crashed with a third in the same step; warmup: would be a crash, but before warmup_s
    vehicle_1          TEXT    NOT NULL,         -- SUMO ids, in order of role
    vehicle_2          TEXT    NOT NULL,
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;

-- Cross-check: every pair of vehicles that SUMO itself reported as colliding, once, and what we
-- made of it.
CREATE TABLE sumo_collision (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of SUMO's first report
    time_s             REAL    NOT NULL,         -- end of the step of SUMO's first report
    collider           TEXT    NOT NULL,         -- SUMO ids
    victim             TEXT    NOT NULL,
    sumo_type          TEXT    NOT NULL,         -- SUMO's word: collision, frontal, junction
    found_as           TEXT    NOT NULL CHECK (found_as IN ('crash', 'graze',
                           'overlap_at_insertion', 'no_common_road', 'after_crash', 'warmup',
                           'no_contact')),
    -- crash: confirmed by us; no_contact: the rectangles never touched; else the verdict on the
    -- contact
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;

-- Pulses at about 1 kHz, compressed: accelerations after a CFC180 filter, the rest as simulated.
-- Decode with crashpulse. codec 1 keeps: accelerations to 0.1 m/s2, velocities to 0.001 m/s,
-- displacements to 0.0001 m, yaw to 0.0001 rad, yaw rate to 0.001 rad/s, yaw acceleration to
-- 1 rad/s2; exactly to these steps.
CREATE TABLE pulse (
    crash_id           INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    codec              INTEGER NOT NULL,         -- way of packing and resolution, see above
    sample_interval_s  REAL    NOT NULL,         -- sample k is k intervals after first contact
    sample_count       INTEGER NOT NULL,
    samples            BLOB    NOT NULL,
    PRIMARY KEY (crash_id, role),
    FOREIGN KEY (crash_id, role) REFERENCES crash_vehicle (crash_id, role)
) STRICT, WITHOUT ROWID;
