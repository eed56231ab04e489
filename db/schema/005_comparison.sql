-- SPDX-License-Identifier: GPL-3.0-or-later
-- Injury risk functions, to be edited by the user, and the results of comparisons, to be joined.

-- Probability of an injury of a given level, or worse, as a function of a severity of the vehicle's
-- crash. Add rows, change them, delete them: comparisons and reports use what stands here. There is
-- none of OLC and none can be entered: no published function leads from OLC to injuries.
CREATE TABLE risk_function (
    name               TEXT    NOT NULL,
    level              TEXT    NOT NULL,         -- MAIS2+, MAIS3+, fatal, …
    predictor          TEXT    NOT NULL CHECK (predictor IN ('delta_v_m_s', 'delta_v_x_m_s',
                           'closing_speed_m_s', 'max_50ms_g', 'asi_1')),
                                                 -- column of crash_vehicle or crash
    unit               TEXT    NOT NULL CHECK (unit IN ('m/s', 'km/h', 'mph', 'g', '1')),
                                                 -- x of the form is the predictor in this unit
    form               TEXT    NOT NULL CHECK (form IN ('logistic', 'log_logistic', 'probit',
                           'weibull')),
    -- logistic: 1 / (1 + exp(-(c0 + c1 x))); log_logistic: the same of ln x; probit: normal
    -- distribution function of c0 + c1 x; weibull: 1 - exp(-(x / c0)^c1)
    coefficients       TEXT    NOT NULL CHECK (json_valid(coefficients)
                                               AND json_array_length(coefficients) = 2), -- [c0, c1]
    source             TEXT    NOT NULL,
    note               TEXT    NOT NULL DEFAULT '',
    PRIMARY KEY (name, level),
    CHECK (CASE WHEN predictor IN ('delta_v_m_s', 'delta_v_x_m_s', 'closing_speed_m_s')
                THEN unit IN ('m/s', 'km/h', 'mph')
                WHEN predictor = 'max_50ms_g' THEN unit = 'g' ELSE unit = '1' END)
) STRICT, WITHOUT ROWID;
INSERT INTO risk_function (name, level, predictor, unit, form, coefficients, source, note) VALUES
    ('Malliaris', 'MAIS2+', 'delta_v_m_s', 'mph', 'logistic', '[-3.761, 0.136]',
     'Malliaris et al. 1997, SAE 970393', 'secondary copy, not checked against the original; crosses the MAIS3+ curve at 65 km/h: above it the two contradict each other'),
    ('Malliaris', 'MAIS3+', 'delta_v_m_s', 'mph', 'logistic', '[-5.450, 0.178]',
     'Malliaris et al. 1997, SAE 970393', 'secondary copy, not checked against the original; crosses the MAIS2+ curve at 65 km/h: above it the two contradict each other'),
    ('Malliaris', 'fatal', 'delta_v_m_s', 'mph', 'logistic', '[-8.252, 0.177]',
     'Malliaris et al. 1997, SAE 970393', 'secondary copy, not checked against the original'),
    ('GIDAS', 'MAIS2+', 'delta_v_m_s', 'm/s', 'logistic', '[-5.820, 0.292]',
     'harm parameters published by TU Munich, fitted to GIDAS',
     'secondary copy, not checked against the original');

-- One comparison as 'crashpulse compare' made it. Making the same one again replaces it.
CREATE TABLE comparison (
    id                 INTEGER PRIMARY KEY,      -- from "baseline|scenario|by|where"
    baseline           TEXT    NOT NULL,         -- variant compared with
    scenario           TEXT    NOT NULL DEFAULT '', -- --scenario; empty: all of them
    by                 TEXT    NOT NULL DEFAULT '', -- --by; empty: one comparison of everything
    where_sql          TEXT    NOT NULL DEFAULT '', -- --where; empty: every vehicle
    design             TEXT    NOT NULL,
    seed               INTEGER NOT NULL,         -- of bootstrap and permutations
    repetitions        INTEGER NOT NULL,         -- of the bootstrap
    permutations       INTEGER NOT NULL,         -- of the tests
    replications       INTEGER NOT NULL,         -- finished, that it rests on
    crashes            INTEGER NOT NULL,         -- likewise
    answer             TEXT    NOT NULL,         -- in one sentence; empty with --by
    crashpulse_version TEXT    NOT NULL
) STRICT;

-- Its figures, one a row.
CREATE TABLE comparison_figure (
    comparison_id      INTEGER NOT NULL REFERENCES comparison (id) ON DELETE CASCADE,
    number             INTEGER NOT NULL,         -- from 0, as printed
    by_value           TEXT    NOT NULL,         -- group of --by; empty without
    variant            TEXT    NOT NULL,
    against            TEXT    NOT NULL,         -- baseline of a contrast; empty: figure of a variant
    scope              TEXT    NOT NULL,         -- all, inside (the validated range); empty: does not
                                                 -- matter
    quantity           TEXT    NOT NULL,         -- with its unit: olc_median_g, rate_ratio, …
    relation           TEXT    NOT NULL CHECK (relation IN ('', '=', '<', '>')),
                                                 -- < and >: censoring leaves it open to one side
    value              REAL,                     -- NULL: undefined
    low                REAL,                     -- 95 % interval; NULL: none, or open to that side
    high               REAL,
    interval           TEXT,                     -- bootstrap, poisson, or why there is none
    PRIMARY KEY (comparison_id, number)
) STRICT, WITHOUT ROWID;
