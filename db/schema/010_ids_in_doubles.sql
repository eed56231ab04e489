-- SPDX-License-Identifier: GPL-3.0-or-later
-- Row ids that a double holds: crash.id was up to 2^62, and R, jq and JavaScript, which know numbers
-- as doubles, took several crashes for one. It is now replication_id * 2^14 + number, below 2^53,
-- with replication.id the first 39 bits of its hash, no longer 42. Every id stays what it was made
-- from, in the same order.

-- The only place that held the old rule. Constraints are not part of what is on the disk, so the
-- text of the table may be changed (sqlite.org, "ALTER TABLE", 7).
PRAGMA writable_schema = ON;
UPDATE sqlite_schema
SET sql = replace(replace(sql, 'replication_id * 1048576 + number AND number BETWEEN 0 AND 1048575',
                          'replication_id * 16384 + number AND number BETWEEN 0 AND 16383'),
                  'replication_id * 2^20 + number', 'replication_id * 2^14 + number')
WHERE type = 'table' AND name = 'crash';
PRAGMA writable_schema = RESET;

-- Ids are fixed, but for this once.
DROP TRIGGER replication_stays;
DROP TRIGGER crash_stays;
DROP TRIGGER crash_vehicle_copies_stay;

UPDATE replication SET id = id >> 3;
UPDATE attempt SET replication_id = replication_id >> 3;
UPDATE contact SET replication_id = replication_id >> 3;
UPDATE sumo_collision SET replication_id = replication_id >> 3;
UPDATE crash SET id = (id >> 23) * 16384 + (id & 1048575), replication_id = replication_id >> 3,
    follows_crash_id = (follows_crash_id >> 23) * 16384 + (follows_crash_id & 1048575);
UPDATE crash_vehicle SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);
UPDATE pulse SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);
UPDATE pre_crash_sample SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);
UPDATE null_treatment SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);
UPDATE counterfactual SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);
UPDATE counterfactual_vehicle SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);
UPDATE counterfactual_pulse SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);
UPDATE counterfactual_sample SET crash_id = (crash_id >> 23) * 16384 + (crash_id & 1048575);

CREATE TRIGGER crash_vehicle_copies_stay
BEFORE UPDATE OF crash_id, scenario_id, variant_id, crash_type ON crash_vehicle
BEGIN
    SELECT RAISE(ABORT, 'crash_vehicle: crash_id, scenario_id, variant_id and crash_type are fixed');
END;
CREATE TRIGGER crash_stays BEFORE UPDATE OF id, replication_id, crash_type ON crash
BEGIN
    SELECT RAISE(ABORT, 'crash: id, replication_id and crash_type are fixed');
END;
CREATE TRIGGER replication_stays BEFORE UPDATE OF id, scenario_id, variant_id, sweep, seed ON replication
BEGIN
    SELECT RAISE(ABORT, 'replication: id, scenario_id, variant_id, sweep and seed are fixed');
END;
