-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 11: delta-v is that of the whole car (its momentum over its mass) and no longer that of the
-- passenger cell alone; the energy a car absorbed; what the fit of its model leaves open.

-- NULL in rows of earlier versions, whose delta_v_m_s is of the passenger cell's pulse.
ALTER TABLE crash_vehicle ADD COLUMN absorbed_j REAL; -- energy its parts took, with its half of
                                                      -- contact and friction
ALTER TABLE crash_vehicle ADD COLUMN ees_m_s REAL;    -- energy equivalent speed,
                                                      -- sqrt(2 absorbed_j / mass)
ALTER TABLE crash_vehicle ADD COLUMN olc_sd_g REAL;   -- standard deviation of OLC over the ensemble of
                                                      -- its vehicle model, a left-censored one as 0;
                                                      -- NULL: no ensemble, or not frontal
ALTER TABLE counterfactual_vehicle ADD COLUMN absorbed_j REAL;
ALTER TABLE counterfactual_vehicle ADD COLUMN ees_m_s REAL;
ALTER TABLE counterfactual_vehicle ADD COLUMN olc_sd_g REAL;

-- The OLC of a frontally struck vehicle by every parameter set of the ensemble of its vehicle model
-- (member 0, 1, ...; the opponent by the set of the same number, where it has one).
CREATE TABLE crash_vehicle_member (
    crash_id           INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    member             INTEGER NOT NULL,
    olc_g              REAL,                     -- NULL unless olc_status is 'value'
    olc_status         TEXT    NOT NULL CHECK (olc_status IN ('value', 'no_deceleration',
                           'beyond_0_5_s', 'simulation_failed')),
    PRIMARY KEY (crash_id, role, member),
    FOREIGN KEY (crash_id, role) REFERENCES crash_vehicle (crash_id, role),
    CHECK ((olc_g IS NOT NULL) = (olc_status = 'value'))
) STRICT, WITHOUT ROWID;

-- The same of treated crashes.
CREATE TABLE counterfactual_vehicle_member (
    crash_id           INTEGER NOT NULL,
    variant_id         INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    member             INTEGER NOT NULL,
    olc_g              REAL,
    olc_status         TEXT    NOT NULL CHECK (olc_status IN ('value', 'no_deceleration',
                           'beyond_0_5_s', 'simulation_failed')),
    PRIMARY KEY (crash_id, variant_id, role, member),
    FOREIGN KEY (crash_id, variant_id, role)
        REFERENCES counterfactual_vehicle (crash_id, variant_id, role),
    CHECK ((olc_g IS NOT NULL) = (olc_status = 'value'))
) STRICT, WITHOUT ROWID;
