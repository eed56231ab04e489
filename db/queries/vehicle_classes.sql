-- SPDX-License-Identifier: GPL-3.0-or-later
-- Which cars crash, and how differently those of one model? Vehicles of each variant by vehicle model: how
-- many were struck on their front, mean and range of mass. Cars of a fleet
-- are drawn (column drawn); one named car has the same mass in all crashes.
SELECT v.name AS variant, w.vehicle_model, count(*) AS vehicles, sum(w.frontal) AS frontal,
       count(w.drawn) AS drawn, round(avg(w.mass_kg)) AS mass_mean_kg, round(min(w.mass_kg)) AS mass_min_kg,
       round(max(w.mass_kg)) AS mass_max_kg
FROM crash_vehicle AS w JOIN variant AS v ON v.id = w.variant_id
GROUP BY w.variant_id, w.vehicle_model
ORDER BY v.name, vehicles DESC, w.vehicle_model;
