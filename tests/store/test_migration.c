/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

#include "pulse/pulse_codec.h"
#include "store/inspection.h"
#include "store/stored_pulse.h"

#include <sys/wait.h>

/* tests/store/version_1.sql is the dump of a database that the first version wrote: a study of four
 * replications with five crashes. A database of version K is that one with the files 2 ... K of
 * db/schema run on it, so a new version is tested from every earlier one without another line. */

static void shell(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void shell(const char *format, ...)
{
    char command[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(command, sizeof command, format, arguments);
    va_end(arguments);
    if (system(command) != 0)
        fail_msg("failed: %s", command);
}

static const char *source(void)
{
    const char *folder = getenv("CRASHPULSE_SOURCE");
    if (folder == NULL)
        fail_msg("CRASHPULSE_SOURCE names the source folder; run this by ctest");
    return folder;
}

static void make_version(const char *db, int version)
{
    shell("rm -f '%s' '%s-wal' '%s-shm'", db, db, db);
    shell("sqlite3 -bail '%s' < '%s/tests/store/version_1.sql'", db, source());
    for (int k = 2; k <= version; k++)
        shell("cat '%s'/db/schema/%03d_*.sql | sqlite3 -bail '%s'", source(), k, db);
    shell("sqlite3 '%s' 'PRAGMA user_version = %d'", db, version);
}

static char *output_of(const char *db, const char *sql)
{
    char command[2048];
    size_t room = 1 << 20;
    char *text = calloc(1, room);
    assert_non_null(text);
    snprintf(command, sizeof command, "sqlite3 -cmd '.mode quote' '%s' \"%s\"", db, sql);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    assert_true(fread(text, 1, room - 1, pipe) > 0);
    assert_int_equal(pclose(pipe), 0);
    return text;
}

// Ids of replications and crashes as they are now; before, they did not fit into a double.
#define NEW_REPLICATION "replication_id"
#define NEW_CRASH "crash_id"
#define OLD_REPLICATION "replication_id >> 3"
#define OLD_CRASH "(crash_id >> 23) * 16384 + (crash_id & 1048575)"

#define ROWS_OF_VERSION_1(replication, crash)                                                      \
    "SELECT id, name, design, seed, yaml, hash FROM study; SELECT id, name, sumocfg, files "       \
    "FROM scenario; SELECT * FROM variant; SELECT " replication ", scenario_id, variant_id, "      \
    "sweep, number, seed, status, configuration_hash, vehicle_km, counters FROM (SELECT id AS "    \
    "replication_id, * FROM replication) ORDER BY 1; SELECT " crash ", time_s, "                   \
    "closing_speed_m_s, shift_m FROM (SELECT id AS crash_id, * FROM crash) ORDER BY 1; "           \
    "SELECT " crash                                                                                \
    ", role, sumo_id, yaw_rad, olc_g, delta_v_m_s, end_s FROM crash_vehicle ORDER BY 1, "          \
    "2; SELECT " crash ", role, codec, sample_interval_s, sample_count, hex(samples) FROM pulse "  \
    "ORDER BY 1, 2; SELECT " replication                                                           \
    ", number, time_s, x_m, y_m, verdict, vehicle_1, vehicle_2 FROM contact; SELECT " replication  \
    ", number, time_s, collider, "                                                                 \
    "victim, sumo_type, found_as FROM sumo_collision; SELECT " replication                         \
    ", number, host, pid, outcome FROM attempt; SELECT name, hash, yaml FROM vehicle_model"

// What the first version knew, column by column, of the tables it had.
static char *rows_of_version_1(const char *db, bool old_ids)
{
    return output_of(db, old_ids ? ROWS_OF_VERSION_1(OLD_REPLICATION, OLD_CRASH)
                                 : ROWS_OF_VERSION_1(NEW_REPLICATION, NEW_CRASH));
}

// Every table, view, index and trigger with its columns, however it came to be.
static char *structure(const char *db)
{
    return output_of(
        db,
        "SELECT m.type, m.name, m.tbl_name, p.cid, p.name, p.type, p.\\\"notnull\\\", p.pk FROM "
        "sqlite_schema AS m LEFT JOIN pragma_table_info(m.name) AS p WHERE m.name NOT LIKE "
        "'sqlite_stat%' ORDER BY 1, 2, 4");
}

// The first version whose ids are what they are now.
static int version_of_ids(void)
{
    char command[2048];
    int version = 0;
    snprintf(command, sizeof command, "ls '%s'/db/schema/*_ids_in_doubles.sql | sed 's/.*\\///'",
             source());
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    assert_int_equal(fscanf(pipe, "%d", &version), 1);
    pclose(pipe);
    return version;
}

static void migrates_from_every_version(void **state)
{
    const fixture *f = *state;
    char fresh[128];
    cp_store *store = NULL;
    cp_error error = {0};
    cp_inspection inspection;
    snprintf(fresh, sizeof fresh, "%s/fresh.db", f->folder);
    assert_ok(cp_store_open(fresh, CP_STORE_CREATE, &store, &error), &error);
    cp_store_close(store);
    char *wanted = structure(fresh);
    for (int version = 1; version < CP_STORE_VERSION; version++) {
        print_message("from version %d to %d\n", version, CP_STORE_VERSION);
        make_version(f->db, version);
        char *before = rows_of_version_1(f->db, version < version_of_ids());

        // Reading does not change it, and says what would.
        assert_int_equal(cp_store_open(f->db, CP_STORE_READ, &store, &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "older crashpulse"));
        assert_non_null(strstr(error.text, "check --upgrade"));

        assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
        assert_true(number_of(store, "PRAGMA user_version") == CP_STORE_VERSION);
        assert_true(number_of(store, "SELECT sum(crashes) FROM olc_by_variant") == 5);
        // How those crashes came about is not known, which is not the same as no error.
        assert_true(number_of(store, "SELECT count(*) FROM crash_vehicle WHERE mass_kg IS NULL AND "
                                     "lane IS NULL AND edge IS NULL AND junction IS NULL AND "
                                     "error_count IS NULL") == 10);
        assert_true(number_of(store, "SELECT (SELECT count(*) FROM crash_driver_error) + (SELECT "
                                     "count(*) FROM crash_function)") == 0);
        assert_ok(cp_inspection_run(store, &inspection, &error), &error);
        assert_int_equal(inspection.wrong, 0);
        cp_store_close(store);

        char *after = rows_of_version_1(f->db, false);
        char *found = structure(f->db);
        assert_string_equal(after, before);
        assert_string_equal(found, wanted);
        free(before);
        free(after);
        free(found);
    }
    free(wanted);
}

// Every row that names a replication or a crash names the same one after its id became one that a
// double holds; numbers that do not fit leave the database as it was.
static void ids_become_whole_numbers_of_a_double(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    make_version(f->db, version_of_ids() - 1);
    shell("sqlite3 '%s' \"INSERT INTO crash SELECT id + 100, replication_id, number + 100, time_s, "
          "x_m, "
          "y_m, crash_type, closing_speed_m_s, lateral_offset_m, angle_rad, overlap_1, validity, "
          "t_common_s, separation_s, shift_m, 1, id FROM crash ORDER BY id LIMIT 1\"",
          f->db);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM crash WHERE id >= 9007199254740992") == 0);
    assert_true(number_of(store, "SELECT count(*) FROM crash WHERE typeof(id) = 'integer' AND "
                                 "id = CAST(CAST(id AS REAL) AS INTEGER)") == 6);
    assert_true(number_of(store,
                          "SELECT count(*) FROM crash_vehicle JOIN crash AS c ON c.id = "
                          "crash_id JOIN replication AS r ON r.id = c.replication_id") == 10);
    assert_true(number_of(store, "SELECT count(*) FROM crash AS c JOIN crash AS o ON o.id = "
                                 "c.follows_crash_id WHERE c.number = o.number + 100") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM pragma_foreign_key_check") == 0);
    assert_true(number_of(store, "SELECT count(*) FROM sqlite_schema WHERE sql LIKE '%1048575%'") ==
                0);
    cp_store_close(store);

    // The rule holds for what comes next.
    shell("! sqlite3 '%s' 'UPDATE crash SET number = number + 1' 2>/dev/null", f->db);

    // A replication of more crashes than there is room for: nothing is changed.
    make_version(f->db, version_of_ids() - 1);
    shell("sqlite3 '%s' \"INSERT INTO crash SELECT id + 20000, replication_id, number + 20000, "
          "time_s, "
          "x_m, y_m, crash_type, closing_speed_m_s, lateral_offset_m, angle_rad, overlap_1, "
          "validity, t_common_s, separation_s, shift_m, 0, NULL FROM crash ORDER BY id LIMIT 1\"",
          f->db);
    char *before = rows_of_version_1(f->db, false);
    assert_int_equal(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), CP_STORE_FAILED);
    assert_non_null(strstr(error.text, "CHECK"));
    char *after = rows_of_version_1(f->db, false);
    assert_string_equal(after, before);
    free(before);
    free(after);
}

// What version 6 counted of a network's background are as many contacts, and a row of their run.
static void counted_backgrounds_become_contacts(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    make_version(f->db, 8);
    shell(
        "sqlite3 '%s' \"INSERT INTO background SELECT id, 3, 0.05, 900.0, 120.5, 'graze', '', 12 "
        "FROM scenario LIMIT 1; INSERT INTO background SELECT id, 3, 0.05, 900.0, 120.5, 'crash', "
        "'front-side', 2 FROM scenario LIMIT 1; INSERT INTO background SELECT id, 4, 0.05, 900.0, "
        "121.5, 'none', '', 0 FROM scenario LIMIT 1\"",
        f->db);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM background_run WHERE vehicle_h IS NULL AND "
                                 "configuration_hash = ''") == 2);
    assert_true(number_of(store, "SELECT sum(vehicle_km) FROM background_run") == 242.0);
    assert_true(number_of(store, "SELECT contacts FROM background_by_reason WHERE reason = "
                                 "'graze'") == 12);
    assert_true(number_of(store, "SELECT contacts FROM background_by_reason WHERE reason = 'crash' "
                                 "AND crash_type = 'front-side'") == 2);
    assert_true(number_of(store, "SELECT max(number) FROM background_contact") == 13);
    cp_store_close(store);
}

// What was shipped becomes history; what its user edited or added stays in use, under its name.
static void risk_functions_of_users_stay(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    make_version(f->db, 12);
    shell(
        "sqlite3 '%s' \"UPDATE risk_function SET coefficients = '[-4, 0.1]' WHERE name = "
        "'Malliaris' AND level = 'fatal'; INSERT INTO risk_function VALUES ('NASS-CDS', 'MAIS2+', "
        "'asi_1', '1', 'logistic', '[-3, 1]', 'mine', '')\"",
        f->db);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM risk_function WHERE use_as = 'history'") ==
                2);
    assert_true(number_of(store, "SELECT count(*) FROM risk_function WHERE use_as = 'default' AND "
                                 "name = 'Malliaris' AND coefficients = '[-4, 0.1]'") == 1);
    assert_true(number_of(store,
                          "SELECT count(*) FROM risk_function WHERE use_as = 'default' AND "
                          "name = 'NASS-CDS' AND level = 'MAIS2+' AND source = 'mine'") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM risk_function WHERE name LIKE 'NASS%'") ==
                8);
    cp_store_close(store);
}

// Pulses that the first codec packed, and what the program of that version unpacked of them.
static void first_codec_is_read(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    cp_pulse pulse;
    make_version(f->db, 1);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM pulse WHERE codec = 1") == 10);
    double id = number_of(store, "SELECT min(id) FROM crash");
    bool there = false;
    assert_ok(cp_stored_pulse_read(store, (int64_t)id, NULL, "a", &pulse, &there, &error), &error);
    assert_true(there);
    assert_int_equal(pulse.sample_count, 401);
    assert_true(fabs(pulse.channel[CP_CHANNEL_VX][0] - 2.815) < 1e-9);
    assert_true(fabs(pulse.channel[CP_CHANNEL_VX][100] - 0.898) < 1e-9);
    assert_true(fabs(pulse.channel[CP_CHANNEL_X][200] - 0.2587) < 1e-9);
    assert_true(fabs(pulse.channel[CP_CHANNEL_AX][30] - -33.8) < 1e-9);
    cp_pulse_destroy(&pulse);
    cp_store_close(store);
}

// A step that cannot be taken leaves the database as it was, and all others' rows too.
static void failed_migration_changes_nothing(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    make_version(f->db, 1);
    shell("sqlite3 '%s' 'CREATE TABLE pulse_channel (mine)'", f->db);
    char *before = structure(f->db);
    assert_int_equal(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), CP_STORE_FAILED);
    assert_non_null(strstr(error.text, "bringing the schema to version 3"));
    assert_non_null(strstr(error.text, "pulse_channel"));
    char *after = structure(f->db);
    assert_string_equal(after, before);
    shell("test $(sqlite3 '%s' 'PRAGMA user_version') = 1", f->db);
    free(before);
    free(after);
}

// A row that points nowhere is found before the new version is committed.
static void dangling_rows_stop_a_migration(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    make_version(f->db, 1);
    shell("sqlite3 '%s' 'DELETE FROM vehicle_model'", f->db);
    assert_int_equal(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), CP_STORE_FAILED);
    assert_non_null(strstr(error.text, "10 rows of crash_vehicle name rows of vehicle_model"));
    shell("test $(sqlite3 '%s' 'PRAGMA user_version') = 1", f->db);
}

// Several programs that open an old database at once: one migrates, all can work.
static void migrates_once_for_many(void **state)
{
    const fixture *f = *state;
    make_version(f->db, 1);
    pid_t pids[6];
    for (int k = 0; k < 6; k++) {
        pids[k] = fork();
        assert_true(pids[k] >= 0);
        if (pids[k] == 0) {
            cp_store *store = NULL;
            cp_status status = cp_store_open(f->db, CP_STORE_WRITE, &store, NULL);
            cp_store_close(store);
            _exit(status == CP_OK ? 0 : 1);
        }
    }
    for (int k = 0; k < 6; k++) {
        int status = 0;
        assert_int_equal(waitpid(pids[k], &status, 0), pids[k]);
        assert_int_equal(status, 0);
    }
    shell("test $(sqlite3 '%s' 'PRAGMA user_version') = %d", f->db, CP_STORE_VERSION);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(ids_become_whole_numbers_of_a_double, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(risk_functions_of_users_stay, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(migrates_from_every_version, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(counted_backgrounds_become_contacts, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(first_codec_is_read, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(failed_migration_changes_nothing, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(dangling_rows_stop_a_migration, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(migrates_once_for_many, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
