-- SPDX-License-Identifier: GPL-3.0-or-later
-- What takes severities out of the validated range? Frontally struck vehicles of each variant by single
-- reasons, and how many have no other: those would be inside if the range were wider there. A vehicle
-- with several reasons stands under each of them.
SELECT x.variant, x.reason, count(*) AS vehicles, sum(v.validity = x.reason) AS this_alone
FROM validity_reason AS x
JOIN crash_vehicle AS v ON v.crash_id = x.crash_id AND v.role = x.role
WHERE x.frontal = 1
GROUP BY x.variant, x.reason
ORDER BY x.variant, vehicles DESC, x.reason;
