-- SPDX-License-Identifier: GPL-3.0-or-later
-- What kinds of crashes are there? Crashes of every type, their share within the variant, how many
-- lie inside the validated range and how fast they close.
SELECT variant, crash_type, crashes,
       round(1.0 * crashes / sum(crashes) OVER (PARTITION BY variant), 3) AS share,
       inside_validity, round(3.6 * closing_speed_mean_m_s, 1) AS closing_speed_mean_km_h
FROM crash_type_by_variant
ORDER BY variant, crashes DESC, crash_type;
