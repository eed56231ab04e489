-- SPDX-License-Identifier: GPL-3.0-or-later
-- What were the functions doing when it crashed all the same? Cars in frontal crashes by function and
-- state at contact, how long before contact the function warned and braking began, and how much speed the
-- car had lost since. Means over the cars that have a value; negative: faster again by then. In a
-- counterfactual study the treated crashes, without those that were avoided.
SELECT scenario, variant, function, state, count(*) AS cars,
       round(avg(warned_s), 2) AS warned_mean_s, round(avg(braking_s), 2) AS braking_mean_s,
       round(avg(brake_request_m_s2), 2) AS brake_request_mean_m_s2,
       round(max(deceleration_m_s2), 2) AS deceleration_max_m_s2,
       round(3.6 * avg(speed_taken_off_m_s), 1) AS speed_taken_off_mean_km_h,
       round(3.6 * avg(speed_m_s), 1) AS speed_at_contact_mean_km_h
FROM function_at_contact
WHERE crash_type LIKE 'front-%'
GROUP BY scenario, variant, is_treated, number, function, state
ORDER BY scenario, variant, is_treated, number, cars DESC, state;
