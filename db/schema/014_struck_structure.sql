-- SPDX-License-Identifier: GPL-3.0-or-later
-- Version 14: how far a vehicle was pushed in where it was struck, and the lateral counterpart of
-- max_50ms_g. Delta-v by axis, pdof_rad and asi_1 have been there from the beginning: with these they
-- are what speaks of a struck side or rear, of which OLC says nothing (olc_status not_front_contact).
--
-- From this version on sides and rears collapse; severities of crashes of earlier versions that are not
-- front-front are of elastic ones, and have NULL in the new columns.

ALTER TABLE crash_vehicle ADD COLUMN intrusion_m REAL CHECK (intrusion_m >= 0.0);
    -- permanent: a struck side or rear from its outline, a front into the passenger cell; NULL: not
    -- simulated
ALTER TABLE crash_vehicle ADD COLUMN intrusion_zone TEXT CHECK (intrusion_zone IN ('front',
    'front_wheel', 'door', 'rear_wheel', 'rear')); -- of a side the one that took most energy
ALTER TABLE crash_vehicle ADD COLUMN max_50ms_y_g REAL; -- largest 50 ms moving mean of |a_y|

ALTER TABLE counterfactual_vehicle ADD COLUMN intrusion_m REAL CHECK (intrusion_m >= 0.0);
ALTER TABLE counterfactual_vehicle ADD COLUMN intrusion_zone TEXT CHECK (intrusion_zone IN ('front',
    'front_wheel', 'door', 'rear_wheel', 'rear'));
ALTER TABLE counterfactual_vehicle ADD COLUMN max_50ms_y_g REAL;
