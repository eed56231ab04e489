-- SPDX-License-Identifier: GPL-3.0-or-later
-- Crash by crash: OLC of the baseline's frontal crash and of what it became under each treatment
-- (design counterfactual; no row in the other designs), 0 when avoided; the larger of the two vehicles.
SELECT p.scenario, p.replication, p.crash_id, p.variant AS treatment, p.outcome_olc AS outcome,
       round(p.baseline_olc_g, 1) AS baseline_olc_g, round(p.treated_olc_g, 1) AS treated_olc_g,
       round(p.treated_olc_g - p.baseline_olc_g, 1) AS change_g
FROM counterfactual_pair AS p
WHERE p.baseline_crash_type LIKE 'front-%' AND p.outcome <> 'invalid'
  AND p.baseline_olc_g IS NOT NULL AND p.treated_olc_g IS NOT NULL
ORDER BY p.scenario, p.replication, p.crash_id, p.variant;
