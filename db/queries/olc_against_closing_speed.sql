-- SPDX-License-Identifier: GPL-3.0-or-later
-- OLC against closing speed, one row a frontally struck vehicle, with what it hit and whether the
-- crash lies inside the range the surrogate was validated in.
SELECT variant, scenario, crash_type, role, round(3.6 * closing_speed_m_s, 1) AS closing_speed_km_h,
       round(olc_g, 2) AS olc_g, olc_status, validity
FROM frontal_vehicle
ORDER BY variant, scenario, crash_id, role;
