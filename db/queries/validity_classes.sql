-- SPDX-License-Identifier: GPL-3.0-or-later
-- Which tests speak for the severities? Frontally struck vehicles of each variant by the class of tests
-- around them, its share, and the relative error of severity there; 'none': outside, by which reasons says
-- validity_reasons.sql.
SELECT variant, coalesce(evidence_class, 'none') AS evidence_class, count(*) AS vehicles,
       round(1.0 * count(*) / sum(count(*)) OVER (PARTITION BY variant), 3) AS share,
       round(avg(class_error_1), 3) AS error_1, round(avg(class_error_g), 2) AS error_g
FROM frontal_vehicle
GROUP BY variant, evidence_class
ORDER BY variant, vehicles DESC, evidence_class;
