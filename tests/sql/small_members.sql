-- SPDX-License-Identifier: GPL-3.0-or-later
-- For an invented study whose vehicles have no ensemble: two parameter sets by which every OLC is
-- 1 g higher and 1 g lower. Left-censored vehicles stay so, failed ones have none.
INSERT INTO crash_vehicle_member (crash_id, role, member, olc_g, olc_status)
SELECT crash_id, role, member, olc_g + 1.0 - 2.0 * member, olc_status
FROM crash_vehicle CROSS JOIN (SELECT 0 AS member UNION SELECT 1)
WHERE frontal = 1 AND olc_status <> 'simulation_failed';
INSERT INTO counterfactual_vehicle_member (crash_id, variant_id, role, member, olc_g, olc_status)
SELECT crash_id, variant_id, role, member, olc_g + 1.0 - 2.0 * member, olc_status
FROM counterfactual_vehicle CROSS JOIN (SELECT 0 AS member UNION SELECT 1)
WHERE frontal = 1 AND olc_status <> 'simulation_failed';
