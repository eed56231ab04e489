-- SPDX-License-Identifier: GPL-3.0-or-later
-- How many crashes are the network's doing, not the drivers'? What each network gives without any
-- driver error or function, and how many crashes that makes in as many vehicle-km as the baseline has.
SELECT scenario, round(vehicle_h, 1) AS vehicle_h, crashes, other_contacts,
       (SELECT group_concat(reason || ' ' || contacts, ', ')
        FROM (SELECT reason, sum(contacts) AS contacts FROM background_by_reason AS r
              WHERE r.scenario_id = b.scenario_id GROUP BY reason ORDER BY reason)) AS contacts,
       round(expected_crashes, 1) AS expected_crashes, baseline_crashes, is_negligible
FROM background_by_scenario AS b;
