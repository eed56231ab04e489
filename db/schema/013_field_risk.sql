-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 13: injury risk fitted to field crashes, with terms for classes of crashes and drivers and
-- the covariance of what was fitted; which functions comparisons use. Those that were shipped before
-- stay as history unless they were edited.

-- Probability of an injury of a given level, or worse, as a function of a severity of the vehicle's
-- crash. Add rows, change them, delete them: comparisons and reports use those of use_as 'default'.
-- There is none of OLC and none can be entered: no published function leads from OLC to injuries.
CREATE TABLE risk_function_13 (
    name               TEXT    NOT NULL,
    level              TEXT    NOT NULL,         -- MAIS2+, MAIS3+, fatal, …
    predictor          TEXT    NOT NULL CHECK (predictor IN ('delta_v_m_s', 'delta_v_x_m_s',
                           'delta_v_without_rebound_m_s', 'closing_speed_m_s', 'max_50ms_g',
                           'asi_1')),
                                                 -- column of crash_vehicle or crash, or of the view
                                                 -- delta_v_without_rebound
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
    -- Added to c0 where a class applies: [{"name": "front-side", "of": "crash_type", "add": -1.46},
    -- {"name": "age 70+", "of": "age", "add": 2.2, "share": 0.06}, …]. Of the classes of one thing
    -- at most one applies, without any c0 stands alone. The crash type is known of every crash; of
    -- anything else the risk is the mean over the classes with these shares of the drivers (change
    -- them for drivers of another mix).
    terms              TEXT    NOT NULL DEFAULT '[]' CHECK (json_valid(terms)
                                               AND json_type(terms) = 'array'),
    -- Covariance of c0, c1 and the terms, lower triangle row by row: [v00, v10, v11, v20, …]; NULL:
    -- unknown, and no interval carries what is uncertain of the function.
    covariance         TEXT             CHECK (covariance IS NULL OR (json_valid(covariance)
                           AND json_array_length(covariance) = (2 + json_array_length(terms))
                                                         * (3 + json_array_length(terms)) / 2)),
    freedom            REAL             CHECK (freedom > 0), -- degrees, of the covariance; NULL: many
    drivers            TEXT    NOT NULL DEFAULT 'both' CHECK (drivers IN ('both', 'frontal')),
                                                 -- whose risk it is: of both vehicles of a frontal
                                                 -- crash, or of those struck on their front
    use_as             TEXT    NOT NULL DEFAULT 'default'
                               CHECK (use_as IN ('default', 'offered', 'history')),
                                                 -- default: in every comparison and report; the
                                                 -- others wait for an UPDATE to 'default'
    PRIMARY KEY (name, level),
    CHECK (CASE WHEN predictor IN ('max_50ms_g') THEN unit = 'g' WHEN predictor = 'asi_1'
                THEN unit = '1' ELSE unit IN ('m/s', 'km/h', 'mph') END)
) STRICT, WITHOUT ROWID;
INSERT INTO risk_function_13 (name, level, predictor, unit, form, coefficients, source, note, use_as)
SELECT name, level, predictor, unit, form, coefficients, source, note,
       CASE WHEN (name, level, predictor, unit, form, coefficients) IN (VALUES
                ('Malliaris', 'MAIS2+', 'delta_v_m_s', 'mph', 'logistic', '[-3.761, 0.136]'),
                ('Malliaris', 'MAIS3+', 'delta_v_m_s', 'mph', 'logistic', '[-5.450, 0.178]'),
                ('Malliaris', 'fatal', 'delta_v_m_s', 'mph', 'logistic', '[-8.252, 0.177]'))
            THEN 'history'
            WHEN (name, level, predictor, unit, form, coefficients) IN (VALUES
                ('GIDAS', 'MAIS2+', 'delta_v_m_s', 'm/s', 'logistic', '[-5.820, 0.292]'))
            THEN 'offered' ELSE 'default' END
FROM risk_function;
DROP TABLE risk_function;
ALTER TABLE risk_function_13 RENAME TO risk_function;
UPDATE risk_function SET note = note || '; older cars and all use of belts, as far as known: 52 % '
    || 'MAIS3+ at 50 km/h where belted drivers of NASS-CDS have 13 % (10 to 17)'
WHERE use_as = 'history';

-- Belted drivers of front-damaged cars in crashes of two, NASS-CDS 2000 to 2015; fitted, and these rows
-- compared in a test, by db/field/risk.py. The delta-v of the field is without rebound.
INSERT INTO risk_function (name, level, predictor, unit, form, coefficients, terms, covariance,
                           freedom, drivers, source, note, use_as)
VALUES
    ('NASS-CDS', 'MAIS2+', 'delta_v_without_rebound_m_s', 'km/h', 'logistic',
     '[-5.08188, 0.08715096]',
     '[]',
     '[0.02470847, -0.0007699576, 2.754132e-05]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'belted drivers, frontal, two light vehicles, tow-away', 'default'),
    ('NASS-CDS', 'MAIS3+', 'delta_v_without_rebound_m_s', 'km/h', 'logistic',
     '[-7.047922, 0.1024961]',
     '[]',
     '[0.0821842, -0.002072581, 5.798204e-05]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'belted drivers, frontal, two light vehicles, tow-away', 'default'),
    ('NASS-CDS', 'fatal', 'delta_v_without_rebound_m_s', 'km/h', 'logistic',
     '[-10.40429, 0.1113989]',
     '[]',
     '[0.338606, -0.002298875, 3.831798e-05]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'belted drivers, frontal, two light vehicles, tow-away; of 86 deaths only', 'offered'),
    ('NASS-CDS by type and age', 'MAIS2+', 'delta_v_without_rebound_m_s', 'km/h', 'logistic',
     '[-5.24849, 0.08770279]',
     '[{"name": "front-side", "of": "crash_type", "add": -0.6292721}, {"name": "front-rear",
      "of": "crash_type", "add": -1.870673}, {"name": "age 35-54", "of": "age", "add":
      0.604988, "share": 0.3075}, {"name": "age 55-69", "of": "age", "add": 0.7200838, "share":
      0.1228}, {"name": "age 70+", "of": "age", "add": 1.199026, "share": 0.0582}, {"name":
      "female", "of": "sex", "add": 0.6804818, "share": 0.4544}]',
     '[0.05991629, -0.001215152, 3.013009e-05, -0.008730054, 0.0003968169, 0.03739529,
      -0.008106737, -7.661289e-06, -0.03337956, 0.08157412, -0.0285534, 0.000401924,
      -0.01651018, 0.02348012, 0.03391213, -0.01119925, 6.866036e-05, -0.0215711, 0.01135721,
      0.01702299, 0.02303473, 0.01259256, -0.0004353199, -0.02166628, -0.00502108, 0.004562086,
      0.02003837, 0.03806275, -0.008792251, 0.000102862, -0.003299542, 0.0007114319,
      0.006491261, 0.004871303, -0.0005535125, 0.007257948]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'the same with crash type, age and sex of the driver; shares of age and sex: those drivers', 'default'),
    ('NASS-CDS by type and age', 'MAIS3+', 'delta_v_without_rebound_m_s', 'km/h', 'logistic',
     '[-6.887664, 0.09801963]',
     '[{"name": "front-side", "of": "crash_type", "add": -1.463373}, {"name": "front-rear",
      "of": "crash_type", "add": -2.027461}, {"name": "age 35-54", "of": "age", "add":
      0.9726871, "share": 0.3075}, {"name": "age 55-69", "of": "age", "add": 1.283282, "share":
      0.1228}, {"name": "age 70+", "of": "age", "add": 2.216535, "share": 0.0582}, {"name":
      "female", "of": "sex", "add": 0.1219741, "share": 0.4544}]',
     '[0.2454138, -0.004328784, 8.313941e-05, -0.05729689, 0.0006261524, 0.09436081,
      -0.08069287, 0.0012988, 0.08068416, 0.09590784, -0.05717195, 0.0007949227, -0.01295264,
      -0.01576535, 0.05584339, -0.06259685, 0.000967057, -0.003390754, -0.003205475,
      0.04212886, 0.0468214, -0.01329465, 0.0003382043, -0.02659166, -0.0366783, 0.003093218,
      0.008995125, 0.08679844, -0.07689869, 0.001524486, 0.003072668, 0.01718939, 0.007047889,
      0.01024928, 0.02413036, 0.04108449]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'the same with crash type, age and sex of the driver; shares of age and sex: those drivers', 'default'),
    ('NASS-CDS by type and age', 'fatal', 'delta_v_without_rebound_m_s', 'km/h', 'logistic',
     '[-9.839423, 0.1025911]',
     '[{"name": "front-side", "of": "crash_type", "add": -2.445395}, {"name": "front-rear",
      "of": "crash_type", "add": -4.171178}, {"name": "age 35-54", "of": "age", "add":
      0.7827926, "share": 0.3075}, {"name": "age 55-69", "of": "age", "add": 1.838247, "share":
      0.1228}, {"name": "age 70+", "of": "age", "add": 2.978965, "share": 0.0582}, {"name":
      "female", "of": "sex", "add": -0.9852937, "share": 0.4544}]',
     '[1.03065, -0.003855985, 3.597372e-05, -0.4896114, 0.00257942, 0.4837716, -0.409647,
      0.001714828, 0.1191462, 0.8299519, -0.3906024, 0.0003463671, 0.09972416, 0.1278142,
      0.2448286, -0.1055917, -0.0005153042, -0.03219137, 0.03141771, 0.1158687, 0.08490548,
      -0.5743953, 0.001157503, 0.2150535, 0.2147895, 0.2679857, 0.107689, 0.4449787,
      -0.3444377, 0.0002878877, 0.1059369, 0.1403068, 0.1551567, 0.05895639, 0.2258079,
      0.2208193]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'the same with crash type, age and sex of the driver; shares of age and sex: those drivers; of 86 deaths only', 'offered'),
    ('NASS-CDS with rebound', 'MAIS2+', 'delta_v_m_s', 'km/h', 'logistic',
     '[-5.08188, 0.08715096]',
     '[]',
     '[0.02470847, -0.0007699576, 2.754132e-05]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'the function of delta-v alone taken at delta-v with rebound: too high, for comparison', 'offered'),
    ('NASS-CDS with rebound', 'MAIS3+', 'delta_v_m_s', 'km/h', 'logistic',
     '[-7.047922, 0.1024961]',
     '[]',
     '[0.0821842, -0.002072581, 5.798204e-05]',
     15, 'frontal', 'NASS-CDS 2000-2015, db/field/risk.py',
     'the function of delta-v alone taken at delta-v with rebound: too high, for comparison', 'offered')
ON CONFLICT (name, level) DO NOTHING; -- a row of the user keeps its name
