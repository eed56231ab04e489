/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

#include "core/file.h"

static void creates_and_reopens(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    assert_ok(cp_store_open(f->db, CP_STORE_CREATE, &store, &error), &error);
    assert_true(number_of(store, "PRAGMA user_version") == CP_STORE_VERSION);
    assert_true(number_of(store, "PRAGMA foreign_keys") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM olc_by_variant") == 0);
    cp_store_close(store);
    assert_ok(cp_store_open(f->db, CP_STORE_READ, &store, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM study") == 0);
    cp_store_close(store);
}

static void read_needs_an_existing_database(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    assert_int_equal(cp_store_open(f->db, CP_STORE_READ, &store, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "no such database"));
    assert_null(store);
    assert_int_equal(access(f->db, F_OK), -1);
}

static void refuses_what_is_no_database(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    char text[8192];
    memset(text, 'x', sizeof text);
    assert_ok(cp_file_write(f->db, text, sizeof text, &error), &error);
    assert_int_equal(cp_store_open(f->db, CP_STORE_CREATE, &store, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "not a database"));

    // The file of somebody else is untouched.
    char *content = NULL;
    size_t size = 0;
    assert_ok(cp_file_read(f->db, &content, &size, &error), &error);
    assert_int_equal(size, sizeof text);
    assert_memory_equal(content, text, size);
    free(content);
}

static void shell(const fixture *f, const char *sql)
{
    char command[512];
    snprintf(command, sizeof command, "sqlite3 '%s' \"%s\"", f->db, sql);
    assert_int_equal(system(command), 0);
}

static void refuses_the_database_of_another_program(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    shell(f, "CREATE TABLE addresses (name)");
    assert_int_equal(cp_store_open(f->db, CP_STORE_CREATE, &store, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "not a database of crashpulse"));
}

static void refuses_a_newer_schema(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    assert_ok(cp_store_open(f->db, CP_STORE_CREATE, &store, &error), &error);
    cp_store_close(store);
    shell(f, "PRAGMA user_version=9999");
    for (int mode = CP_STORE_READ; mode <= CP_STORE_CREATE; mode++) {
        assert_int_equal(cp_store_open(f->db, (cp_store_mode)mode, &store, &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "newer"));
    }
}

static void plain_sqlite_answers(void **state)
{
    const fixture *f = *state;
    small_plan plan;
    cp_store *store = open_planned(f, &plan);
    double olc_g[] = {20.0};
    finish_replication_with(store, &plan, 0, olc_g, 1);
    cp_store_close(store);
    char command[256], line[64] = "";
    snprintf(command, sizeof command,
             "sqlite3 '%s' 'SELECT variant, crashes, olc_median_g FROM olc_by_variant'", f->db);
    FILE *shell_output = popen(command, "r");
    assert_non_null(shell_output);
    assert_non_null(fgets(line, sizeof line, shell_output));
    assert_int_equal(pclose(shell_output), 0);
    assert_string_equal(line, "baseline|1|25.0\n");
}

static void rollback_leaves_nothing(void **state)
{
    const fixture *f = *state;
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(f, &plan);
    cp_store *other = NULL;
    assert_ok(cp_store_begin(store, &error), &error);
    assert_ok(cp_store_open(f->db, CP_STORE_READ, &other, &error), &error);
    assert_true(number_of(other, "SELECT count(*) FROM replication") == 4);
    cp_store_rollback(store);
    cp_store_rollback(store);
    cp_store_close(other);
    cp_store_close(store);
}

// A view that another program wrote under one of our names, and one of the user's own.
static void views_are_those_of_this_program(void **state)
{
    const fixture *f = *state;
    small_plan plan;
    cp_error error = {0};
    char *before = NULL, *after = NULL;
    size_t size = 0, size_after = 0;
    cp_store_close(open_planned(f, &plan));
    shell(f,
          "DROP VIEW views_written; DROP VIEW olc_by_variant; DROP VIEW progress; CREATE VIEW "
          "olc_by_variant AS SELECT 4711 AS crashes; CREATE VIEW mine AS SELECT 1 AS one; PRAGMA "
          "journal_mode=DELETE");

    // Who reads sees ours; the file is not touched.
    cp_store *store = NULL;
    assert_ok(cp_file_read(f->db, &before, &size, &error), &error);
    assert_ok(cp_store_open(f->db, CP_STORE_READ, &store, &error), &error);
    assert_true(number_of(store, "SELECT sum(crashes) FROM olc_by_variant") == 0);
    assert_true(number_of(store, "SELECT sum(planned) FROM progress") == 4);
    cp_store_close(store);
    assert_ok(cp_file_read(f->db, &after, &size_after, &error), &error);
    assert_int_equal(size, size_after);
    assert_memory_equal(before, after, size);
    free(before);
    free(after);

    // Who writes brings them up to date for everyone; the user's stay.
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    cp_store_close(store);
    assert_ok(cp_store_open(f->db, CP_STORE_READ, &store, &error), &error);
    assert_true(number_of(store, "SELECT one FROM mine") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM temp.sqlite_schema") == 0);
    assert_true(number_of(store, "SELECT sum(crashes) FROM main.olc_by_variant") == 0);
    cp_store_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(creates_and_reopens, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(read_needs_an_existing_database, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(refuses_what_is_no_database, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(refuses_the_database_of_another_program, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(refuses_a_newer_schema, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(plain_sqlite_answers, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(rollback_leaves_nothing, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(views_are_those_of_this_program, fixture_begin,
                                        fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
