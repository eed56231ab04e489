-- SPDX-License-Identifier: GPL-3.0-or-later
-- What became of the baseline's frontal crashes under each treatment (design counterfactual; zeros in
-- the other designs). The outcomes add up to crashes.
SELECT v.name AS treatment, count(c.id) AS crashes,
       coalesce(sum(x.outcome = 'avoided'), 0) AS avoided,
       coalesce(sum(x.outcome = 'mitigated'), 0) AS mitigated,
       coalesce(sum(x.outcome = 'unchanged'), 0) AS unchanged,
       coalesce(sum(x.outcome = 'aggravated'), 0) AS aggravated,
       coalesce(sum(x.outcome = 'changed_opponent'), 0) AS changed_opponent,
       coalesce(sum(x.outcome = 'invalid'), 0) AS invalid,
       coalesce(sum(x.new_crashes), 0) AS new_crashes,
       sum(x.vanished_crashes) AS vanished_crashes -- NULL: not known, of an earlier version
FROM variant AS v
LEFT JOIN counterfactual AS x ON x.variant_id = v.id
LEFT JOIN crash AS c ON c.id = x.crash_id AND c.crash_type LIKE 'front-%'
WHERE v.is_baseline = 0 AND (x.crash_id IS NULL OR c.id IS NOT NULL)
GROUP BY v.id
ORDER BY v.number;
