-- SPDX-License-Identifier: GPL-3.0-or-later
-- Expected injured drivers per million vehicle-km of every variant, by every default logistic risk
-- function of delta-v, with a 95 % interval. scatter_se_1: relative standard error from how
-- replications scatter within their scenario; risk_se_1: what the coefficients of the function leave
-- open (their covariance, delta method; NULL: unknown). The interval joins both on the logarithmic
-- scale with 1.96 and, of few degrees of freedom, 1.96 (1 + 1.2 / freedom) standard errors;
-- 'crashpulse compare' has the one by bootstrap. Drivers of whom no delta-v is known are left out.
WITH RECURSIVE f AS (
    SELECT *, CASE unit WHEN 'km/h' THEN 3.6 WHEN 'mph' THEN 3600.0 / 1609.344 ELSE 1.0 END AS per_si
    FROM risk_function
    WHERE use_as = 'default' AND form = 'logistic'
      AND predictor IN ('delta_v_m_s', 'delta_v_without_rebound_m_s')
), term AS (
    SELECT f.name, f.level, 2 + t.key AS parameter, t.value ->> 'name' AS class,
           t.value ->> 'of' AS thing, t.value ->> 'add' AS adds, t.value ->> 'share' AS share,
           dense_rank() OVER (PARTITION BY f.name, f.level, t.value ->> 'of' = 'crash_type'
                              ORDER BY t.value ->> 'of') AS number
    FROM f JOIN json_each(f.terms) AS t
), class AS (
    -- of everything but the crash type, and who is in none of the classes
    SELECT name, level, number, parameter, adds, share FROM term WHERE thing <> 'crash_type'
    UNION ALL
    SELECT name, level, number, NULL, 0.0, 1.0 - sum(share) FROM term
    WHERE thing <> 'crash_type' GROUP BY name, level, number
), mix (name, level, number, adds, share, chosen) AS (
    -- drivers by all of them together
    SELECT name, level, 0, 0.0, 1.0, '|' FROM f
    UNION ALL
    SELECT m.name, m.level, c.number, m.adds + c.adds, m.share * c.share,
           m.chosen || coalesce(c.parameter || '|', '')
    FROM mix AS m JOIN class AS c USING (name, level) WHERE c.number = m.number + 1
), whole AS (
    SELECT * FROM mix AS m
    WHERE number = coalesce((SELECT max(number) FROM class AS c
                             WHERE c.name = m.name AND c.level = m.level), 0)
), driver AS MATERIALIZED (
    SELECT c.replication_id, w.variant_id, w.crash_type, w.frontal, w.delta_v_m_s,
           e.delta_v_without_rebound_m_s
    FROM crash_vehicle AS w
    JOIN crash AS c ON c.id = w.crash_id
    JOIN delta_v_without_rebound AS e ON e.crash_id = w.crash_id AND e.role = w.role
    WHERE w.crash_type LIKE 'front-%' AND w.delta_v_m_s IS NOT NULL
), risk AS MATERIALIZED (
    SELECT f.name, f.level, d.replication_id, d.variant_id, w.share, w.chosen, t.parameter,
           f.per_si * CASE f.predictor WHEN 'delta_v_m_s' THEN d.delta_v_m_s
                                       ELSE d.delta_v_without_rebound_m_s END AS x,
           1.0 / (1.0 + exp(-((f.coefficients ->> 0) + coalesce(t.adds, 0) + w.adds
               + (f.coefficients ->> 1) * f.per_si * CASE f.predictor WHEN 'delta_v_m_s'
                     THEN d.delta_v_m_s ELSE d.delta_v_without_rebound_m_s END))) AS p
    FROM f JOIN driver AS d ON d.frontal = 1 OR f.drivers = 'both'
    JOIN whole AS w ON w.name = f.name AND w.level = f.level
    LEFT JOIN term AS t ON t.name = f.name AND t.level = f.level AND t.thing = 'crash_type'
                       AND t.class = d.crash_type
), injured AS (
    SELECT name, level, variant_id, replication_id, sum(share * p) AS expected
    FROM risk GROUP BY name, level, variant_id, replication_id
), parameter AS (
    SELECT name, level, 0 AS number FROM f UNION ALL SELECT name, level, 1 FROM f
    UNION ALL SELECT name, level, parameter FROM term
), slope AS (
    -- of the sum, by each coefficient and term
    SELECT r.name, r.level, r.variant_id, p.number,
           sum(r.share * r.p * (1 - r.p) * CASE WHEN p.number = 0 THEN 1.0 WHEN p.number = 1 THEN r.x
               ELSE p.number = r.parameter OR instr(r.chosen, '|' || p.number || '|') > 0 END) AS slope
    FROM risk AS r JOIN parameter AS p USING (name, level)
    GROUP BY r.name, r.level, r.variant_id, p.number
), variance AS (
    SELECT a.name, a.level, a.variant_id, f.freedom,
           sum(a.slope * b.slope * (f.covariance ->> (max(a.number, b.number)
               * (max(a.number, b.number) + 1) / 2 + min(a.number, b.number)))) AS of_sum
    FROM slope AS a JOIN slope AS b USING (name, level, variant_id) JOIN f USING (name, level)
    GROUP BY a.name, a.level, a.variant_id
), replicated AS (
    SELECT f.name, f.level, r.variant_id, r.scenario_id, r.vehicle_km,
           coalesce(i.expected, 0) AS expected
    FROM f JOIN replication AS r ON r.status = 'done'
    LEFT JOIN injured AS i ON i.name = f.name AND i.level = f.level AND i.replication_id = r.id
), by_scenario AS (
    SELECT *, sum(expected) OVER s / sum(vehicle_km) OVER s AS rate, count(*) OVER s AS n
    FROM replicated WINDOW s AS (PARTITION BY name, level, variant_id, scenario_id)
), summed AS (
    SELECT name, level, variant_id, sum(expected) AS expected, 1e6 * sum(expected) / sum(vehicle_km)
               AS per_million_km,
           sqrt(sum(n / (n - 1.0) * (expected - rate * vehicle_km) * (expected - rate * vehicle_km)))
               / nullif(sum(expected), 0) AS scatter_se_1
    FROM by_scenario GROUP BY name, level, variant_id
), joined AS (
    SELECT s.*, sqrt(v.of_sum) / s.expected AS risk_se_1,
           1.96 * sqrt(s.scatter_se_1 * s.scatter_se_1 + coalesce(v.of_sum / s.expected / s.expected
               * (1 + 1.2 / v.freedom) * (1 + 1.2 / v.freedom), 0)) AS reach
    FROM summed AS s LEFT JOIN variance AS v USING (name, level, variant_id)
)
SELECT v.name AS variant, j.level, j.name AS risk_function, j.expected AS expected_injured,
       round(j.per_million_km, 3) AS per_million_km, round(j.scatter_se_1, 4) AS scatter_se_1,
       round(j.risk_se_1, 4) AS risk_se_1, round(j.per_million_km * exp(-j.reach), 3) AS low,
       round(j.per_million_km * exp(j.reach), 3) AS high
FROM joined AS j JOIN variant AS v ON v.id = j.variant_id
ORDER BY v.number, j.name, j.level;
