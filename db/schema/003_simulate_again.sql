-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 3: what a crash needs to be simulated again from the database alone, parameter sweeps,
-- where merged rows came from, and the pulse codecs as rows.

-- How the surrogate was run: {"time_step_s": …, "duration_s": …, "longest_duration_s": …,
-- "coast_after_s": …}. With vehicle_model.yaml and the state of both cars in crash_vehicle this
-- gives the stored pulses again. NULL until done, and for rows of earlier versions (0.0005, 0.2, 0.4, 0.01).
ALTER TABLE replication ADD COLUMN crash_options TEXT
    CHECK (crash_options IS NULL OR json_valid(crash_options));

-- Parameters that the study sweeps. A swept scenario or variant is in the table scenario or variant
-- once for each value (or combination of values), named "base@parameter=value".
CREATE TABLE sweep_value (
    owner              TEXT    NOT NULL CHECK (owner IN ('scenario', 'variant')),
    owner_id           INTEGER NOT NULL,         -- scenario.id or variant.id
    base               TEXT    NOT NULL,         -- its name in the study file
    parameter          TEXT    NOT NULL,         -- key path: variants.aeb.aeb.ttc_s
    value              REAL    NOT NULL,
    PRIMARY KEY (owner, owner_id, parameter)
) STRICT, WITHOUT ROWID;

-- Where rows that 'crashpulse merge' brought here were computed. Like attempt, not a result: leave
-- it out to compare two databases.
CREATE TABLE merge_source (
    number             INTEGER PRIMARY KEY,      -- in order of merging
    database           TEXT    NOT NULL,         -- file name as given
    merged             TEXT    NOT NULL,         -- UTC, ISO 8601
    replications       INTEGER NOT NULL          -- taken from it, those already here left out
) STRICT;

-- Channels of a stored pulse. samples of table pulse decodes to whole multiples of the resolution,
-- exactly, in the order of number; the codec says how they are packed (src/pulse/pulse_codec.h). The
-- SQL extension unpacks: pulse_samples(crash_id, role).
CREATE TABLE pulse_channel (
    codec              INTEGER NOT NULL,         -- pulse.codec
    number             INTEGER NOT NULL,         -- from 0
    name               TEXT    NOT NULL,
    unit               TEXT    NOT NULL,
    resolution         REAL    NOT NULL,         -- in that unit
    what               TEXT    NOT NULL,
    PRIMARY KEY (codec, number)
) STRICT, WITHOUT ROWID;
WITH codec(codec) AS (VALUES (1), (2)),
     channel(number, name, unit, resolution, what) AS (VALUES
    (0, 'ax_m_s2', 'm/s2', 0.1, 'acceleration along the vehicle''s x axis, CFC180'),
    (1, 'ay_m_s2', 'm/s2', 0.1, 'acceleration along the vehicle''s y axis, CFC180'),
    (2, 'vx_m_s', 'm/s', 0.001, 'integral of the unfiltered ax in the turning axes'),
    (3, 'vy_m_s', 'm/s', 0.001, 'integral of the unfiltered ay in the turning axes'),
    (4, 'x_m', 'm', 0.0001, 'of the centre of gravity, in the axes at first contact'),
    (5, 'y_m', 'm', 0.0001, 'of the centre of gravity, in the axes at first contact'),
    (6, 'yaw_rad', 'rad', 0.0001, 'heading against that at first contact, counter-clockwise'),
    (7, 'yaw_rate_rad_s', 'rad/s', 0.001, 'yaw rate'),
    (8, 'yaw_acc_rad_s2', 'rad/s2', 1.0, 'yaw acceleration, CFC180'))
INSERT INTO pulse_channel SELECT codec, number, name, unit, resolution, what FROM codec, channel;
