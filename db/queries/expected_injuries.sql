-- SPDX-License-Identifier: GPL-3.0-or-later
-- Expected injured drivers of the frontal crashes of every variant by every logistic risk function of
-- delta-v: both drivers, one per vehicle, whatever their validity. Other forms: README.
SELECT v.name AS variant, f.level, f.name AS risk_function, count(*) AS drivers,
       sum(1.0 / (1.0 + exp(-((f.coefficients ->> 0) + (f.coefficients ->> 1) * w.delta_v_m_s
           * CASE f.unit WHEN 'km/h' THEN 3.6 WHEN 'mph' THEN 3600.0 / 1609.344 ELSE 1.0 END))))
           AS expected_injured
FROM crash_vehicle AS w
JOIN variant AS v ON v.id = w.variant_id
CROSS JOIN risk_function AS f
WHERE w.crash_type LIKE 'front-%' AND w.delta_v_m_s IS NOT NULL
  AND f.predictor = 'delta_v_m_s' AND f.form = 'logistic'
GROUP BY v.id, f.name, f.level
ORDER BY v.number, f.name, f.level;
