-- SPDX-License-Identifier: GPL-3.0-or-later
-- What made these results: for every replication its seed, program versions and the hash of
-- everything its outcome depends on.
SELECT s.name AS scenario, v.name AS variant, r.number, r.seed, r.status, r.crashpulse_version,
       r.sumo_version, r.configuration_hash
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
ORDER BY s.number, v.number, r.number;
