/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

typedef struct seen_rows {
    char columns[128];
    char rows[512];
    size_t count;
} seen_rows;

static cp_status see_columns(void *context, const cp_row *row, cp_error *error)
{
    seen_rows *seen = context;
    (void)error;
    assert_null(row->cell);
    for (size_t k = 0; k < row->column_count; k++) {
        strcat(seen->columns, row->column[k]);
        strcat(seen->columns, ";");
    }
    return CP_OK;
}

static cp_status see_row(void *context, const cp_row *row, cp_error *error)
{
    seen_rows *seen = context;
    (void)error;
    seen->count++;
    for (size_t k = 0; k < row->column_count; k++) {
        char text[64];
        const cp_cell *cell = &row->cell[k];
        snprintf(text, sizeof text, "%d:%g:%s;", (int)cell->type, cell->real, cell->text);
        strcat(seen->rows, text);
    }
    return CP_OK;
}

static cp_status stop_at_first(void *context, const cp_row *row, cp_error *error)
{
    seen_rows *seen = context;
    (void)row;
    seen->count++;
    return cp_fail(error, CP_INTERRUPTED, "enough");
}

static cp_status run(cp_store *store, const char *sql, seen_rows *seen, cp_error *error)
{
    cp_query_handler handler = {.columns = see_columns, .row = see_row, .context = seen};
    return cp_query(store, sql, NULL, 0, &handler, error);
}

static void gives_typed_cells(void **state)
{
    small_plan plan;
    seen_rows seen = {0};
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    assert_ok(
        run(store, "SELECT 1 AS one, 2.5 AS real, 'text' AS word, NULL AS empty;  ", &seen, &error),
        &error);
    assert_string_equal(seen.columns, "one;real;word;empty;");
    assert_string_equal(seen.rows, "1:1:;2:2.5:;3:nan:text;0:nan:;");
    cp_store_close(store);
}

static void names_columns_without_rows(void **state)
{
    small_plan plan;
    seen_rows seen = {0};
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    assert_ok(run(store, "SELECT time_s, crash_type FROM crash -- none yet", &seen, &error),
              &error);
    assert_string_equal(seen.columns, "time_s;crash_type;");
    assert_int_equal(seen.count, 0);
    cp_store_close(store);
}

static void binds_parameters(void **state)
{
    small_plan plan;
    seen_rows seen = {0};
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    cp_query_handler handler = {.row = see_row, .context = &seen};
    cp_cell parameters[] = {cp_cell_text("aeb"), cp_cell_integer(5), cp_cell_real(NAN)};
    assert_ok(cp_query(store, "SELECT name, ?2, ?3 FROM variant WHERE name = ?1", parameters, 3,
                       &handler, &error),
              &error);
    assert_string_equal(seen.rows, "3:nan:aeb;1:5:;0:nan:;");
    cp_store_close(store);
}

static void refuses_bad_sql(void **state)
{
    static const char *const BAD[] = {"SELEC 1",
                                      "SELECT no_such_column FROM crash",
                                      "DELETE FROM crash",
                                      "DROP TABLE crash",
                                      "UPDATE study SET seed = 1",
                                      "SELECT 1; DELETE FROM replication",
                                      "SELECT 1; nonsense",
                                      "",
                                      "-- only a comment",
                                      "SELECT json('{')"};
    small_plan plan;
    cp_store *store = open_planned(*state, &plan);
    for (size_t k = 0; k < sizeof BAD / sizeof BAD[0]; k++) {
        seen_rows seen = {0};
        cp_error error = {0};
        assert_int_equal(run(store, BAD[k], &seen, &error), CP_BAD_INPUT);
        assert_int_equal(error.status, CP_BAD_INPUT);
        assert_true(strlen(error.text) > 0);
    }
    assert_true(number_of(store, "SELECT count(*) FROM replication") == 4);
    cp_store_close(store);
}

static void callback_can_stop_it(void **state)
{
    small_plan plan;
    seen_rows seen = {0};
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    cp_query_handler handler = {.row = stop_at_first, .context = &seen};
    assert_int_equal(cp_query(store, "SELECT * FROM replication", NULL, 0, &handler, &error),
                     CP_INTERRUPTED);
    assert_int_equal(seen.count, 1);
    assert_string_equal(error.text, "enough");
    cp_store_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(gives_typed_cells, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(names_columns_without_rows, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(binds_parameters, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(refuses_bad_sql, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(callback_can_stop_it, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
