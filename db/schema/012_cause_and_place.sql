-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 12: which driver errors led to a crash, what the functions of both cars did before it, where
-- on the network it happened, and how heavy both cars are.
--
-- All of it is written when the traffic is simulated and cannot be told afterwards: crashes of earlier
-- versions have NULL in the new columns and no rows in the new tables.

ALTER TABLE crash_vehicle ADD COLUMN mass_kg REAL;  -- of its vehicle model; NULL: no model, or not known
ALTER TABLE crash_vehicle ADD COLUMN lane TEXT;     -- SUMO's, of its front at the end of the step of
                                                    -- contact; NULL: not known, as the next two
ALTER TABLE crash_vehicle ADD COLUMN edge TEXT;     -- of that lane
ALTER TABLE crash_vehicle ADD COLUMN junction TEXT; -- that the lane lies in; NULL on a road, too
-- error_count: its rows in crash_driver_error; 0: its driver made no error; NULL: not known.
ALTER TABLE crash_vehicle ADD COLUMN error_count INTEGER CHECK (error_count >= 0);

ALTER TABLE counterfactual_vehicle ADD COLUMN mass_kg REAL;
ALTER TABLE counterfactual_vehicle ADD COLUMN lane TEXT;
ALTER TABLE counterfactual_vehicle ADD COLUMN edge TEXT;
ALTER TABLE counterfactual_vehicle ADD COLUMN junction TEXT;
ALTER TABLE counterfactual_vehicle ADD COLUMN error_count INTEGER CHECK (error_count >= 0);

-- The other way round than new_crashes: confirmed crashes of the baseline between others, from the
-- checkpoint to the horizon, that do not happen with the treatment; NULL when invalid, or not known.
ALTER TABLE counterfactual ADD COLUMN vanished_crashes INTEGER;

-- The errors that the driver of a crashed car made within 5 s before contact, one row for each driver
-- error of the scenario; none for a car that had crashed before and stood there.
CREATE TABLE crash_driver_error (
    crash_id           INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    number             INTEGER NOT NULL,         -- place among the scenario's driver errors, from 0
    driver_error       TEXT    NOT NULL,         -- failed_to_see, lane_drift, ...
    towards            TEXT    NOT NULL CHECK (towards IN ('everybody', 'opponent', 'another')),
                                                 -- opponent, another: an error towards one particular
                                                 -- other, who is the other of this crash or not
    began_s            REAL    NOT NULL,         -- before contact, the last time it began
    ended_s            REAL    NOT NULL,         -- before contact; 0: at work at contact
    is_cause           INTEGER NOT NULL CHECK (is_cause IN (0, 1)),
                                                 -- 1: towards everybody or the opponent, and at work
                                                 -- at contact or within 3 s before it
    PRIMARY KEY (crash_id, role, number),
    FOREIGN KEY (crash_id, role) REFERENCES crash_vehicle (crash_id, role),
    CHECK (began_s >= ended_s AND ended_s BETWEEN 0.0 AND 5.0),
    CHECK (is_cause = (towards <> 'another' AND ended_s <= 3.0))
) STRICT, WITHOUT ROWID;
CREATE INDEX crash_driver_error_cause ON crash_driver_error (driver_error, is_cause);

-- What each function of the variant did to a crashed car: one row for each function and car. Times are
-- before contact; what was over more than 5 s before it is not told.
CREATE TABLE crash_function (
    crash_id           INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    number             INTEGER NOT NULL,         -- place among the variant's functions, from 0
    function           TEXT    NOT NULL,         -- aeb, fcw, ...
    state              TEXT    NOT NULL CHECK (state IN ('not_equipped', 'idle', 'limiting', 'warned',
                           'requested', 'braking', 'steering', 'released')),
                                                 -- at contact. idle: it did nothing; limiting: it
                                                 -- keeps the car to a speed limit; warned: and nobody
                                                 -- brakes yet; requested: braking or steering is to
                                                 -- come after a dead time; braking: for a warning, the
                                                 -- driver who heeds it; released: it was over by then
    warned_s           REAL,                     -- since the warning; NULL: none
    requested_s        REAL,                     -- since the request; NULL: none
    braking_s          REAL,                     -- since deceleration began to rise; NULL: it did not
    steering_s         REAL,                     -- since steering began; NULL: it did not
    released_s         REAL,                     -- since it was over; NULL: it was not, or did nothing
    brake_request_m_s2 REAL,                     -- deceleration it asked for at contact; NULL: none
    deceleration_m_s2  REAL,                     -- largest of the car since braking_s, mean of a step,
                                                 -- by whomever; NULL without braking_s
    speed_taken_off_m_s REAL,                    -- speed of the car at the end of the last step before
                                                 -- its braking minus at contact, by whomever, SUMO's;
                                                 -- NULL without braking_s
    PRIMARY KEY (crash_id, role, number),
    FOREIGN KEY (crash_id, role) REFERENCES crash_vehicle (crash_id, role),
    CHECK ((state = 'released') = (released_s IS NOT NULL)),
    CHECK ((braking_s IS NULL) = (speed_taken_off_m_s IS NULL)),
    CHECK (coalesce(warned_s, requested_s, braking_s, steering_s) IS NULL
           OR state NOT IN ('not_equipped', 'idle'))
) STRICT, WITHOUT ROWID;

-- The same of treated crashes.
CREATE TABLE counterfactual_driver_error (
    crash_id           INTEGER NOT NULL,
    variant_id         INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    number             INTEGER NOT NULL,
    driver_error       TEXT    NOT NULL,
    towards            TEXT    NOT NULL CHECK (towards IN ('everybody', 'opponent', 'another')),
    began_s            REAL    NOT NULL,
    ended_s            REAL    NOT NULL,
    is_cause           INTEGER NOT NULL CHECK (is_cause IN (0, 1)),
    PRIMARY KEY (crash_id, variant_id, role, number),
    FOREIGN KEY (crash_id, variant_id, role)
        REFERENCES counterfactual_vehicle (crash_id, variant_id, role),
    CHECK (began_s >= ended_s AND ended_s BETWEEN 0.0 AND 5.0),
    CHECK (is_cause = (towards <> 'another' AND ended_s <= 3.0))
) STRICT, WITHOUT ROWID;

-- The baseline's functions first, then the treatment's.
CREATE TABLE counterfactual_function (
    crash_id           INTEGER NOT NULL,
    variant_id         INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    number             INTEGER NOT NULL,
    function           TEXT    NOT NULL,
    state              TEXT    NOT NULL CHECK (state IN ('not_equipped', 'idle', 'limiting', 'warned',
                           'requested', 'braking', 'steering', 'released')),
    warned_s           REAL,
    requested_s        REAL,
    braking_s          REAL,
    steering_s         REAL,
    released_s         REAL,
    brake_request_m_s2 REAL,
    deceleration_m_s2  REAL,
    speed_taken_off_m_s REAL,
    PRIMARY KEY (crash_id, variant_id, role, number),
    FOREIGN KEY (crash_id, variant_id, role)
        REFERENCES counterfactual_vehicle (crash_id, variant_id, role),
    CHECK ((state = 'released') = (released_s IS NOT NULL)),
    CHECK ((braking_s IS NULL) = (speed_taken_off_m_s IS NULL)),
    CHECK (coalesce(warned_s, requested_s, braking_s, steering_s) IS NULL
           OR state NOT IN ('not_equipped', 'idle'))
) STRICT, WITHOUT ROWID;
