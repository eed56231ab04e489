/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/schema_match.h"

#include "store/schema.h"
#include "store/store_sqlite.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

extern const unsigned char cp_views[]; /* db/views.sql, embedded */

// ---- text of a definition ------------------------------------------------------------------

// What follows a comment that begins at text, or text itself.
static const char *skip_comment(const char *text)
{
    if (strncmp(text, "--", 2) == 0)
        return text + strcspn(text, "\n");
    if (strncmp(text, "/*", 2) != 0)
        return text;
    const char *end = strstr(text + 2, "*/");
    return end != NULL ? end + 2 : text + strlen(text);
}

// The next character that counts: no blank, comment or mark around a name, but all of a literal.
static char next_character(const char **text, bool *literal)
{
    while (!*literal) {
        const char *behind = skip_comment(*text);
        if (behind == *text && **text != '\0' && (isspace((unsigned char)**text) || **text == '"'))
            behind++;
        if (behind == *text)
            break;
        *text = behind;
    }
    char c = **text;
    *text += c != '\0';
    *literal ^= c == '\'';
    return c;
}

static bool is_same_definition(const char *one, const char *other)
{
    bool literal[2] = {false, false};
    for (;;) {
        char a = next_character(&one, &literal[0]), b = next_character(&other, &literal[1]);
        if (a != b)
            return false;
        if (a == '\0')
            return true;
    }
}

// ---- a database as it should be ------------------------------------------------------------

static cp_status fail_ours(sqlite3 *ours, cp_error *error)
{
    bool memory = ours == NULL || (sqlite3_errcode(ours) & 0xff) == SQLITE_NOMEM;
    return memory ? cp_fail_memory(error, "the schema")
                  : cp_fail(error, CP_STORE_FAILED, "the schema: %s", sqlite3_errmsg(ours));
}

static cp_status make_ours(int version, sqlite3 **ours, cp_error *error)
{
    if (sqlite3_open_v2(":memory:", ours, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, NULL) !=
        SQLITE_OK)
        return fail_ours(*ours, error);
    for (int k = 0; k < version; k++)
        if (sqlite3_exec(*ours, (const char *)CP_SCHEMA[k], NULL, NULL, NULL) != SQLITE_OK)
            return fail_ours(*ours, error);
    if (version == CP_STORE_VERSION &&
        sqlite3_exec(*ours, (const char *)cp_views, NULL, NULL, NULL) != SQLITE_OK)
        return fail_ours(*ours, error);
    return CP_OK;
}

// ---- comparing -----------------------------------------------------------------------------

static cp_status fail_object(cp_store *store, const char *what, const char *type, const char *name,
                             cp_error *error)
{
    return cp_fail(error, CP_BAD_INPUT,
                   "%s: is not a database as crashpulse makes it: %s %s %s; nothing was read or "
                   "changed",
                   cp_store_path(store), type, name, what);
}

// One definition of ours against the file's. find: by type and name.
static cp_status match_object(cp_store *store, sqlite3_stmt *ours, cp_statement *find, bool *views,
                              cp_error *error)
{
    int row = 0;
    const char *type = (const char *)sqlite3_column_text(ours, 0);
    const char *name = (const char *)sqlite3_column_text(ours, 1);
    const char *wanted = (const char *)sqlite3_column_text(ours, 2);
    if (type == NULL || name == NULL || wanted == NULL)
        return cp_fail_memory(error, "the schema");
    cp_bind_text(find, 1, type);
    cp_bind_text(find, 2, name);
    cp_status status = cp_statement_row(find, &row, error);
    if (status != CP_OK)
        return status;
    const char *found = row ? (const char *)sqlite3_column_text(find->handle, 0) : NULL;
    if (row && found == NULL && sqlite3_column_type(find->handle, 0) != SQLITE_NULL)
        return cp_fail_memory(error, "the schema");
    bool same = found != NULL && is_same_definition(wanted, found);
    if (strcmp(type, "view") == 0)
        *views &= same;
    else if (!same)
        status = fail_object(store, row ? "is another" : "is missing", type, name, error);
    sqlite3_reset(find->handle);
    return status;
}

static cp_status match_objects(cp_store *store, sqlite3 *ours, bool *views, cp_error *error)
{
    sqlite3_stmt *wanted = NULL;
    cp_statement find;
    int result = SQLITE_ROW;
    cp_status status = cp_statement_prepare(
        store, "reading the schema",
        "SELECT sql FROM main.sqlite_schema WHERE type = ?1 AND name = ?2", &find, error);
    if (status == CP_OK && sqlite3_prepare_v2(ours,
                                              "SELECT type, name, sql FROM sqlite_schema WHERE sql "
                                              "IS NOT NULL",
                                              -1, &wanted, NULL) != SQLITE_OK)
        status = fail_ours(ours, error);
    while (status == CP_OK && (result = sqlite3_step(wanted)) == SQLITE_ROW)
        status = match_object(store, wanted, &find, views, error);
    if (status == CP_OK && result != SQLITE_DONE)
        status = fail_ours(ours, error);
    sqlite3_finalize(wanted);
    cp_statement_finish(&find);
    return status;
}

// Triggers of others run with statements of ours.
static cp_status find_foreign_trigger(cp_store *store, sqlite3 *ours, cp_error *error)
{
    cp_statement triggers;
    sqlite3_stmt *known = NULL;
    int row = 0;
    cp_status status = cp_statement_prepare(
        store, "reading the schema", "SELECT name FROM main.sqlite_schema WHERE type = 'trigger'",
        &triggers, error);
    if (status == CP_OK &&
        sqlite3_prepare_v2(ours, "SELECT 1 FROM sqlite_schema WHERE type = 'trigger' AND name = ?1",
                           -1, &known, NULL) != SQLITE_OK)
        status = fail_ours(ours, error);
    while (status == CP_OK && (status = cp_statement_row(&triggers, &row, error)) == CP_OK && row) {
        const char *name = (const char *)sqlite3_column_text(triggers.handle, 0);
        int result = SQLITE_NOMEM;
        if (name != NULL && sqlite3_bind_text(known, 1, name, -1, SQLITE_STATIC) == SQLITE_OK)
            result = sqlite3_step(known);
        if (name == NULL)
            status = cp_fail_memory(error, "the schema");
        else if (result == SQLITE_DONE)
            status = fail_object(store, "is not of crashpulse", "trigger", name, error);
        else if (result != SQLITE_ROW)
            status = fail_ours(ours, error);
        sqlite3_reset(known);
    }
    sqlite3_finalize(known);
    cp_statement_finish(&triggers);
    return status;
}

cp_status cp_schema_match(cp_store *store, int version, bool *views, cp_error *error)
{
    sqlite3 *ours = NULL;
    *views = version == CP_STORE_VERSION;
    cp_status status = make_ours(version, &ours, error);
    if (status == CP_OK)
        status = match_objects(store, ours, views, error);
    if (status == CP_OK)
        status = find_foreign_trigger(store, ours, error);
    sqlite3_close(ours);
    return status;
}
