-- SPDX-License-Identifier: GPL-3.0-or-later
-- The background of a study's networks: what contacts their traffic makes without any driver error
-- or function ('crashpulse background STUDY --db FILE'). Crashes that remain there are the
-- network's doing.
CREATE TABLE background (
    scenario_id        INTEGER NOT NULL REFERENCES scenario (id),
    seed               INTEGER NOT NULL,
    step_length_s      REAL    NOT NULL,
    simulated_s        REAL    NOT NULL,
    vehicle_km         REAL    NOT NULL,
    reason             TEXT    NOT NULL,         -- crash, a verdict as in contact, or none: no
                                                 -- contact at all
    crash_type         TEXT    NOT NULL DEFAULT '', -- of crashes
    contacts           INTEGER NOT NULL,
    PRIMARY KEY (scenario_id, seed, step_length_s, reason, crash_type),
    CHECK ((reason = 'none') = (contacts = 0))
) STRICT, WITHOUT ROWID;

-- How near the two came to each other by our rectangles at SUMO's reports: < 0 they overlap; NULL
-- unknown (one not on the road, or a row of an earlier version).
ALTER TABLE sumo_collision ADD COLUMN gap_m REAL;
