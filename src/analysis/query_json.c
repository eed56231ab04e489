/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/query_json.h"

#include <math.h>

json_t *cp_number_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *cp_cell_json(const cp_cell *cell)
{
    switch (cell->type) {
    case CP_CELL_INTEGER:
        return json_integer(cell->integer);
    case CP_CELL_REAL:
        return cp_number_json(cell->real);
    case CP_CELL_TEXT: {
        json_t *text = json_stringn(cell->text, cell->size);
        return text ? text : json_string("text that is not UTF-8");
    }
    case CP_CELL_BLOB:
        return json_sprintf("blob of %zu bytes", cell->size);
    case CP_CELL_NULL:
        break;
    }
    return json_null();
}

static cp_status add_row(void *context, const cp_row *row, cp_error *error)
{
    json_t *object = json_object();
    for (size_t k = 0; k < row->column_count; k++)
        if (json_object_set_new(object, row->column[k], cp_cell_json(&row->cell[k])) != 0)
            break;
    if (json_object_size(object) == 0 || json_array_append_new(context, object) != 0)
        return cp_fail_memory(error, "the result of a query");
    return CP_OK;
}

cp_status cp_query_json(cp_store *store, const char *sql, json_t **rows, cp_error *error)
{
    *rows = json_array();
    if (!*rows)
        return cp_fail_memory(error, "the result of a query");
    cp_query_handler handler = {.row = add_row, .context = *rows};
    cp_status status = cp_query(store, sql, NULL, 0, &handler, error);
    if (status != CP_OK) {
        json_decref(*rows);
        *rows = NULL;
    }
    return status;
}
