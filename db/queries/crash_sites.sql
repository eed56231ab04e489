-- SPDX-License-Identifier: GPL-3.0-or-later
-- Where do they crash? First contact points of the frontal crashes, in the axes of the SUMO network.
SELECT scenario, variant, replication, number AS crash, round(x_m, 1) AS x_m, round(y_m, 1) AS y_m,
       crash_type, round(closing_speed_m_s * 3.6, 1) AS closing_speed_km_h
FROM crash_list
WHERE frontal
ORDER BY scenario, variant, replication, crash;
