-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 15: cars drawn from vehicle classes, and which class of crash tests speaks for a severity.
--
-- NULL in rows of earlier versions, whose validity is by the calibrated range of their vehicle file.

-- What was drawn of the car of a vehicle class: parameters of its vehicle model that are not those of
-- the file, JSON {"mass_kg": ...}; NULL: none, the file's own car.
ALTER TABLE crash_vehicle ADD COLUMN drawn TEXT;
-- The class of tests (table evidence of db/validation/evidence.csv) that the crash lies within and whose
-- bars the vehicle model keeps; 'own_calibration': within the calibrated range of a vehicle file that the
-- scorecard does not judge; NULL: none, then validity says why.
ALTER TABLE crash_vehicle ADD COLUMN evidence_class TEXT;
ALTER TABLE crash_vehicle ADD COLUMN class_error_1 REAL; -- relative error of severity in that class;
                                                         -- NULL: none, or not known, as the next
ALTER TABLE crash_vehicle ADD COLUMN class_error_g REAL; -- that share of olc_g; 0 where it is censored
ALTER TABLE counterfactual_vehicle ADD COLUMN drawn TEXT;
ALTER TABLE counterfactual_vehicle ADD COLUMN evidence_class TEXT;
ALTER TABLE counterfactual_vehicle ADD COLUMN class_error_1 REAL;
ALTER TABLE counterfactual_vehicle ADD COLUMN class_error_g REAL;
