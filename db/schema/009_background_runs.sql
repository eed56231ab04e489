-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 9: the background of a study's networks belongs to the study: 'crashpulse run' makes it,
-- with every contact.

-- One simulation of a scenario's network without any driver error or function. Scenarios that start
-- SUMO alike (same .sumocfg, options and files) share that of the first of them.
CREATE TABLE background_run (
    scenario_id        INTEGER NOT NULL REFERENCES scenario (id),
    seed               INTEGER NOT NULL,         -- SUMO's
    step_length_s      REAL    NOT NULL,
    simulated_s        REAL    NOT NULL,         -- warm-up not counted, nor in the next three
    vehicle_km         REAL    NOT NULL,
    vehicle_h          REAL,                     -- NULL: of an earlier version
    departed           INTEGER,                  -- vehicles inserted; NULL likewise
    configuration_hash TEXT    NOT NULL,         -- SHA-256 of all that the study's own run depends
                                                 -- on; '' of another seed or length
    crashpulse_version TEXT,
    sumo_version       TEXT,
    sumo_command_line  TEXT,
    PRIMARY KEY (scenario_id, seed, step_length_s)
) STRICT, WITHOUT ROWID;

-- Every contact in it: what of these is a crash, is the network's doing.
CREATE TABLE background_contact (
    scenario_id        INTEGER NOT NULL,
    seed               INTEGER NOT NULL,
    step_length_s      REAL    NOT NULL,
    number             INTEGER NOT NULL,         -- from 0, in order of time
    time_s             REAL,                     -- SUMO clock of first touch; NULL: counted by an
                                                 -- earlier version, which did not keep it
    x_m                REAL,                     -- first contact point, world; NULL likewise
    y_m                REAL,
    reason             TEXT    NOT NULL,         -- crash, or a verdict as in contact
    crash_type         TEXT    NOT NULL DEFAULT '', -- of crashes
    closing_speed_m_s  REAL,                     -- of crashes, as in crash
    lateral_offset_m   REAL,
    angle_rad          REAL,
    vehicle_1          TEXT,                     -- SUMO ids, in order of role
    vehicle_2          TEXT,
    PRIMARY KEY (scenario_id, seed, step_length_s, number),
    FOREIGN KEY (scenario_id, seed, step_length_s)
        REFERENCES background_run (scenario_id, seed, step_length_s)
) STRICT, WITHOUT ROWID;

-- What version 6 counted: as many contacts, of which only the reason is known.
INSERT INTO background_run (scenario_id, seed, step_length_s, simulated_s, vehicle_km,
                            configuration_hash)
SELECT scenario_id, seed, step_length_s, max(simulated_s), max(vehicle_km), ''
FROM background GROUP BY 1, 2, 3;
INSERT INTO background_contact (scenario_id, seed, step_length_s, number, reason, crash_type)
WITH RECURSIVE each AS (
    SELECT scenario_id, seed, step_length_s, reason, crash_type, contacts AS left
    FROM background WHERE contacts > 0
    UNION ALL
    SELECT scenario_id, seed, step_length_s, reason, crash_type, left - 1 FROM each WHERE left > 1
)
SELECT scenario_id, seed, step_length_s,
       row_number() OVER (PARTITION BY scenario_id, seed, step_length_s
                          ORDER BY reason, crash_type, left) - 1, reason, crash_type
FROM each;
DROP TABLE background;
