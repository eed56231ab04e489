-- SPDX-License-Identifier: GPL-3.0-or-later
-- How severe are the crashes? Quantiles of OLC (g) over the frontally struck vehicles of each
-- variant, all of them and those inside the validated range. Vehicles without enough deceleration
-- for an OLC (left-censored) count below every value: a quantile among them is NULL, which means
-- "below olc_min_g". Linear interpolation between order statistics.
WITH scope(scope) AS (VALUES ('all'), ('inside')), observation AS (
    SELECT v.name AS variant, v.number AS place, s.scope, w.olc_g,
           row_number() OVER win - 1 AS below,
           count(*) OVER (PARTITION BY v.id, s.scope) AS n
    FROM crash_vehicle AS w JOIN variant AS v ON v.id = w.variant_id CROSS JOIN scope AS s
    WHERE w.olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')
      AND (s.scope = 'all' OR w.validity = 'inside')
    WINDOW win AS (PARTITION BY v.id, s.scope ORDER BY w.olc_g NULLS FIRST)
), wanted(p) AS (VALUES (0.25), (0.5), (0.75), (0.9), (0.95)), quantile AS (
    -- the two order statistics around rank p (n - 1); no value when the lower one is censored
    SELECT variant, place, scope, p,
           CASE WHEN count(olc_g) = count(*) THEN
               sum(olc_g * (1 - abs(p * (n - 1) - below))) END AS olc_g
    FROM observation CROSS JOIN wanted
    WHERE abs(p * (n - 1) - below) < 1
    GROUP BY variant, scope, p
)
SELECT o.variant, o.scope, count(*) AS vehicles, count(*) - count(o.olc_g) AS censored,
       min(o.olc_g) AS olc_min_g,
       (SELECT q.olc_g FROM quantile AS q WHERE q.variant = o.variant AND q.scope = o.scope AND p = 0.25) AS q25_g,
       (SELECT q.olc_g FROM quantile AS q WHERE q.variant = o.variant AND q.scope = o.scope AND p = 0.5) AS median_g,
       (SELECT q.olc_g FROM quantile AS q WHERE q.variant = o.variant AND q.scope = o.scope AND p = 0.75) AS q75_g,
       (SELECT q.olc_g FROM quantile AS q WHERE q.variant = o.variant AND q.scope = o.scope AND p = 0.9) AS p90_g,
       (SELECT q.olc_g FROM quantile AS q WHERE q.variant = o.variant AND q.scope = o.scope AND p = 0.95) AS p95_g,
       max(o.olc_g) AS olc_max_g
FROM observation AS o
GROUP BY o.place, o.variant, o.scope
ORDER BY o.place, o.scope;
