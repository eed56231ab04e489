/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/query.h"

#include "store/store_sqlite.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

cp_cell cp_cell_integer(int64_t value)
{
    return (cp_cell){.type = CP_CELL_INTEGER, .integer = value, .real = (double)value, .text = ""};
}

cp_cell cp_cell_real(double value)
{
    return (cp_cell){.type = isnan(value) ? CP_CELL_NULL : CP_CELL_REAL, .real = value, .text = ""};
}

cp_cell cp_cell_text(const char *text)
{
    return (cp_cell){.type = text != NULL ? CP_CELL_TEXT : CP_CELL_NULL,
                     .real = NAN,
                     .text = text != NULL ? text : ""};
}

// SQL of the user: what is wrong with it is bad input, not a failed database.
static cp_status fail_sql(cp_store *store, cp_error *error)
{
    int code = sqlite3_errcode(cp_store_sqlite(store)) & 0xff;
    cp_status status = cp_store_fail(store, error, "query");
    bool wrong = code == SQLITE_ERROR || code == SQLITE_AUTH || code == SQLITE_READONLY ||
                 code == SQLITE_MISMATCH || code == SQLITE_RANGE || code == SQLITE_TOOBIG;
    if (wrong && error != NULL)
        error->status = CP_BAD_INPUT;
    return wrong ? CP_BAD_INPUT : status;
}

static bool only_blanks(const char *text)
{
    while (isspace((unsigned char)*text) || *text == ';')
        text++;
    return *text == '\0';
}

// One statement that reads, and nothing behind it.
static cp_status prepare_reading(cp_store *store, const char *sql, sqlite3_stmt **statement,
                                 cp_error *error)
{
    const char *rest = NULL;
    sqlite3 *handle = cp_store_sqlite(store);
    if (sqlite3_prepare_v2(handle, sql, -1, statement, &rest) != SQLITE_OK)
        return fail_sql(store, error);
    if (*statement == NULL)
        return cp_fail(error, CP_BAD_INPUT, "query: there is no statement in it");
    if (!sqlite3_stmt_readonly(*statement))
        return cp_fail(error, CP_BAD_INPUT, "query: only statements that read are allowed");

    // What follows must be blank or a comment: compiles to nothing.
    sqlite3_stmt *second = NULL;
    int result =
        only_blanks(rest) ? SQLITE_OK : sqlite3_prepare_v2(handle, rest, -1, &second, NULL);
    bool more = second != NULL || result != SQLITE_OK;
    sqlite3_finalize(second);
    if (more)
        return cp_fail(error, CP_BAD_INPUT, "query: one statement at a time, found more: %.60s",
                       rest);
    return CP_OK;
}

static cp_status bind_cell(cp_store *store, sqlite3_stmt *statement, int place, const cp_cell *cell,
                           cp_error *error)
{
    int result = SQLITE_OK;
    switch (cell->type) {
    case CP_CELL_NULL:
        result = sqlite3_bind_null(statement, place);
        break;
    case CP_CELL_INTEGER:
        result = sqlite3_bind_int64(statement, place, cell->integer);
        break;
    case CP_CELL_REAL:
        result = sqlite3_bind_double(statement, place, cell->real);
        break;
    case CP_CELL_TEXT:
        result = sqlite3_bind_text(statement, place, cell->text, -1, SQLITE_STATIC);
        break;
    case CP_CELL_BLOB:
        result = sqlite3_bind_blob64(statement, place, cell->text, cell->size, SQLITE_STATIC);
        break;
    }
    return result == SQLITE_OK ? CP_OK : fail_sql(store, error);
}

static cp_cell read_cell(sqlite3_stmt *statement, int column)
{
    cp_cell cell = {.type = CP_CELL_NULL, .real = NAN, .text = ""};
    switch (sqlite3_column_type(statement, column)) {
    case SQLITE_INTEGER:
        cell = cp_cell_integer(sqlite3_column_int64(statement, column));
        break;
    case SQLITE_FLOAT:
        cell.type = CP_CELL_REAL;
        cell.real = sqlite3_column_double(statement, column);
        break;
    case SQLITE_TEXT:
        cell.type = CP_CELL_TEXT;
        cell.text = (const char *)sqlite3_column_text(statement, column);
        break;
    case SQLITE_BLOB:
        cell.type = CP_CELL_BLOB;
        cell.text = sqlite3_column_blob(statement, column);
        break;
    default:
        break;
    }
    cell.size = (size_t)sqlite3_column_bytes(statement, column);
    if (cell.text == NULL)
        cell.text = "";
    return cell;
}

static cp_status deliver_rows(cp_store *store, sqlite3_stmt *statement,
                              const cp_query_handler *handler, cp_error *error)
{
    size_t columns = (size_t)sqlite3_column_count(statement);
    const char **name = calloc(columns + 1, sizeof *name);
    cp_cell *cell = calloc(columns + 1, sizeof *cell);
    cp_status status = CP_OK;
    if (name == NULL || cell == NULL) {
        status = cp_fail_memory(error, "columns of a query");
        goto done;
    }

    // Names first, also for a query without rows.
    for (size_t k = 0; k < columns; k++)
        name[k] = sqlite3_column_name(statement, (int)k);
    cp_row row = {.column_count = columns, .column = name};
    if (handler->columns != NULL)
        status = handler->columns(handler->context, &row, error);

    row.cell = cell;
    while (status == CP_OK) {
        int result = sqlite3_step(statement);
        if (result == SQLITE_DONE)
            break;
        if (result != SQLITE_ROW) {
            status = fail_sql(store, error);
            break;
        }
        for (size_t k = 0; k < columns; k++)
            cell[k] = read_cell(statement, (int)k);
        if (handler->row != NULL)
            status = handler->row(handler->context, &row, error);
    }
done:
    free(cell);
    free(name);
    return status;
}

cp_status cp_query(cp_store *store, const char *sql, const cp_cell *parameters,
                   size_t parameter_count, const cp_query_handler *handler, cp_error *error)
{
    sqlite3_stmt *statement = NULL;
    cp_status status = prepare_reading(store, sql, &statement, error);
    for (size_t k = 0; status == CP_OK && k < parameter_count; k++)
        status = bind_cell(store, statement, (int)k + 1, &parameters[k], error);
    if (status == CP_OK)
        status = deliver_rows(store, statement, handler, error);
    sqlite3_finalize(statement);
    return status;
}

typedef struct one_number {
    double value;
    size_t rows;
} one_number;

static cp_status take_number(void *context, const cp_row *row, cp_error *error)
{
    one_number *number = context;
    if (row->column_count != 1 || number->rows++ > 0)
        return cp_fail(error, CP_BAD_INPUT, "query: one row of one column expected");
    number->value = row->cell[0].real;
    return CP_OK;
}

cp_status cp_query_number(cp_store *store, const char *sql, double *value, cp_error *error)
{
    one_number number = {.value = NAN};
    cp_query_handler handler = {.row = take_number, .context = &number};
    cp_status status = cp_query(store, sql, NULL, 0, &handler, error);
    if (status == CP_OK && (number.rows != 1 || isnan(number.value)))
        status = cp_fail(error, CP_BAD_INPUT, "query: gives no number: %s", sql);
    if (status == CP_OK)
        *value = number.value;
    return status;
}
