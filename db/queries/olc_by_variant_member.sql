-- SPDX-License-Identifier: GPL-3.0-or-later
-- How much do the crash models leave open? Median OLC (g) of each variant by every parameter set of
-- the vehicle models' ensembles, and what it differs from the baseline's by the same set: model
-- error that all crashes share moves medians and leaves most of the difference. A median is NULL
-- where it is left-censored. No rows: no vehicle model of the study has an ensemble (key ensemble of
-- a fit file). Interval: crashpulse compare DB --model-uncertainty.
SELECT o.variant, o.member, o.n AS vehicles, o.with_sets, round(o.olc_median_g, 3) AS median_g,
       round(o.olc_median_g - b.olc_median_g, 3) AS against_baseline_g
FROM olc_by_variant_member AS o
LEFT JOIN olc_by_variant_member AS b ON b.is_baseline = 1 AND b.member = o.member;
