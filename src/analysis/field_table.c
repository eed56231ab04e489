/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/field_table.h"

#include "core/csv_table.h"
#include "core/file.h"
#include "core/memory_stream.h"
#include "core/safe_text.h"

#include <zlib.h>

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const unsigned char cp_field_nass[]; /* db/field/nass_cds.csv.gz, embedded */
extern const size_t cp_field_nass_size;

/* No table is larger when unpacked. */
#define LARGEST ((size_t)256 << 20)

const char *const CP_FIELD_MARGIN_TEXT[CP_FIELD_MARGIN_COUNT] = {
#define MARGIN_TEXT(name, text, classes, ordered) text,
    CP_FIELD_MARGINS(MARGIN_TEXT)
#undef MARGIN_TEXT
};

const size_t CP_FIELD_MARGIN_CLASSES[CP_FIELD_MARGIN_COUNT] = {
#define MARGIN_CLASSES(name, text, classes, ordered) classes,
    CP_FIELD_MARGINS(MARGIN_CLASSES)
#undef MARGIN_CLASSES
};

// ---- classes ---------------------------------------------------------------------------------

static const char *const TYPE[] = {"front-front", "front-side", "front-rear"};
static const double DELTA_V_KM_H[] = {10, 15, 20, 25, 30, 40, 50, 60};
static const double OVERLAP_1[] = {0.25, 0.5, 0.75};

static unsigned char class_of(double value, const double *end, size_t ends)
{
    unsigned char k = 0;
    if (isnan(value))
        return CP_FIELD_UNKNOWN;
    while (k < ends && value >= end[k])
        k++;
    return k;
}

unsigned char cp_field_type_class(const char *crash_type)
{
    for (size_t k = 0; k < sizeof TYPE / sizeof *TYPE; k++)
        if (strcmp(crash_type, TYPE[k]) == 0)
            return (unsigned char)k;
    return CP_FIELD_UNKNOWN;
}

unsigned char cp_field_delta_v_class(double delta_v_km_h)
{
    return class_of(delta_v_km_h, DELTA_V_KM_H, sizeof DELTA_V_KM_H / sizeof *DELTA_V_KM_H);
}

unsigned char cp_field_overlap_class(double overlap_1)
{
    return class_of(overlap_1, OVERLAP_1, sizeof OVERLAP_1 / sizeof *OVERLAP_1);
}

const char *cp_field_class_text(cp_field_margin margin, size_t of)
{
    static const char *const DELTA_V_TEXT[] = {"0-10 km/h",  "10-15 km/h", "15-20 km/h",
                                               "20-25 km/h", "25-30 km/h", "30-40 km/h",
                                               "40-50 km/h", "50-60 km/h", "60 km/h and more"};
    static const char *const OVERLAP_TEXT[] = {"0-0.25", "0.25-0.5", "0.5-0.75", "0.75-1"};
    return margin == CP_FIELD_TYPE      ? TYPE[of]
           : margin == CP_FIELD_DELTA_V ? DELTA_V_TEXT[of]
                                        : OVERLAP_TEXT[of];
}

// ---- reading ---------------------------------------------------------------------------------

// What gzip packed, zero-terminated.
static cp_status unpack(const char *path, const unsigned char *packed, size_t size, char **content,
                        cp_error *error)
{
    z_stream stream = {.next_in = (unsigned char *)packed, .avail_in = (unsigned)size};
    size_t room = 8 * size + 4096;
    int result = inflateInit2(&stream, 15 + 16);
    *content = NULL;
    while (result == Z_OK) {
        char *more = room <= LARGEST ? realloc(*content, room + 1) : NULL;
        if (!more)
            break;
        *content = more;
        stream.next_out = (unsigned char *)*content + stream.total_out;
        stream.avail_out = (unsigned)(room - stream.total_out);
        result = inflate(&stream, Z_NO_FLUSH);
        if (result == Z_OK && stream.avail_out > 0)
            result = Z_BUF_ERROR; // the file ends before its end
        room *= 2;
    }
    if (*content)
        (*content)[stream.total_out] = '\0';
    inflateEnd(&stream);
    if (result == Z_STREAM_END)
        return cp_file_check_text(path, *content, stream.total_out, error);
    if (result == Z_OK || result == Z_MEM_ERROR)
        return room > LARGEST ? cp_fail(error, CP_BAD_INPUT, "%s: unpacks to more than %zu MiB",
                                        path, LARGEST >> 20)
                              : cp_fail_memory(error, path);
    return cp_fail(error, CP_BAD_INPUT, "%s: what gzip packed is damaged", path);
}

// Read once: it may be a pipe.
static cp_status read_text(const char *path, char **content, cp_error *error)
{
    static const char MARK[] = "\xef\xbb\xbf"; // byte order mark of UTF-8
    char *raw = NULL;
    size_t size = 0;
    cp_status status = cp_file_read(path, &raw, &size, error);
    if (status != CP_OK)
        return status;
    if (size >= 2 && (unsigned char)raw[0] == 0x1f && (unsigned char)raw[1] == 0x8b) {
        status = unpack(path, (const unsigned char *)raw, size, content, error);
        free(raw);
        return status;
    }
    *content = raw;
    if (strncmp(raw, MARK, 3) == 0) {
        size -= 3;
        memmove(raw, raw + 3, size + 1);
    }
    return cp_file_check_text(path, raw, size, error);
}

// The rest of a line, and of the comments below that go on with it ("#   ..."), in one line.
static char *joined(const char *from)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&text, &size);
    if (!out)
        return NULL;
    for (;;) {
        from += strspn(from, " ");
        size_t length = strcspn(from, "\r\n");
        fwrite(from, 1, length, out);
        from += length + strspn(from + length, "\r\n");
        if (strncmp(from, "#  ", 3) != 0)
            break;
        fputc(' ', out);
        from++;
    }
    char *plain = fclose(out) == 0 ? cp_text_copy_plain(text) : NULL;
    free(text);
    return plain;
}

// The text of the comment "# key: ..." before the header; NULL: none.
static char *comment(const char *content, const char *key)
{
    size_t length = strlen(key);
    for (const char *line = content; line && line[0] == '#';) {
        if (strncmp(line, "# ", 2) == 0 && strncmp(line + 2, key, length) == 0 &&
            line[2 + length] == ':')
            return joined(line + 3 + length);
        line = strchr(line, '\n');
        line = line ? line + 1 : NULL;
    }
    return NULL;
}

// Whether a column is there that need not be.
static bool has(const cp_csv_table *csv, const char *column)
{
    for (size_t c = 0; c < csv->column_count; c++)
        if (strcmp(csv->column[c], column) == 0)
            return true;
    return false;
}

static cp_status read_values(const cp_csv_table *csv, cp_field_table *table, cp_error *error)
{
    static const struct {
        const char *column;
        double smallest;
        bool needed;
    } COLUMN[CP_FIELD_VALUE_COUNT] = {
        {"delta_v_kmh", 0.0, true}, {"pdof_deg", -180.0, false}, {"overlap_1", 0.0, false}};
    static const double LARGEST_VALUE[CP_FIELD_VALUE_COUNT] = {400.0, 180.0, 1.0};
    cp_status status = CP_OK;
    for (size_t k = 0; k < csv->row_count && status == CP_OK; k++) {
        const char *type = NULL;
        status = cp_csv_table_number(csv, k, "weight", 1e-9, 1e12, false, &table->weight[k], error);
        if (status == CP_OK)
            status = cp_csv_table_text(csv, k, "crash_type", &type, error);
        if (status != CP_OK)
            break;
        table->type[k] = cp_field_type_class(type);
        if (table->type[k] == CP_FIELD_UNKNOWN && type[0] != '\0')
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: crash_type must be front-front, front-side, front-rear or "
                           "empty, found '%s'",
                           csv->path, csv->line[k], type);
        for (int v = 0; v < CP_FIELD_VALUE_COUNT && status == CP_OK; v++) {
            table->value[v][k] = NAN;
            if (COLUMN[v].needed || has(csv, COLUMN[v].column))
                status = cp_csv_table_number(csv, k, COLUMN[v].column, COLUMN[v].smallest,
                                             LARGEST_VALUE[v], true, &table->value[v][k], error);
        }
        table->value[CP_FIELD_VALUE_PDOF][k] = fabs(table->value[CP_FIELD_VALUE_PDOF][k]);
    }
    return status;
}

/* Texts that were seen, in order of appearance. */
typedef struct seen {
    size_t count;
    struct {
        const char *stratum;
        const char *cluster;
    } of[4096];
} seen;

static size_t number_of(seen *s, const char *stratum, const char *cluster)
{
    // The same as before more often than not: from the end.
    for (size_t k = s->count; k-- > 0;)
        if (strcmp(s->of[k].stratum, stratum) == 0 && strcmp(s->of[k].cluster, cluster) == 0)
            return k;
    if (s->count == sizeof s->of / sizeof *s->of)
        return SIZE_MAX;
    s->of[s->count].stratum = stratum;
    s->of[s->count].cluster = cluster;
    return s->count++;
}

static cp_status read_design(const cp_csv_table *csv, cp_field_table *table, cp_error *error)
{
    if (!has(csv, "cluster"))
        return CP_OK;
    seen *strata = calloc(1, sizeof *strata), *clusters = calloc(1, sizeof *clusters);
    cp_status status =
        strata && clusters ? CP_OK : cp_fail_memory(error, "the design of a field table");
    for (size_t k = 0; k < csv->row_count && status == CP_OK; k++) {
        const char *stratum = "", *cluster = "";
        if (has(csv, "stratum"))
            status = cp_csv_table_text(csv, k, "stratum", &stratum, error);
        if (status == CP_OK)
            status = cp_csv_table_text(csv, k, "cluster", &cluster, error);
        if (status != CP_OK)
            break;
        table->stratum[k] = number_of(strata, stratum, "");
        table->cluster[k] = number_of(clusters, stratum, cluster);
        if (table->stratum[k] == SIZE_MAX || table->cluster[k] == SIZE_MAX)
            status = cp_fail(error, CP_BAD_INPUT,
                             "%s:%zu: strata and clusters must be at most 4096 each; leave the "
                             "column cluster out if every row is one",
                             csv->path, csv->line[k]);
    }
    if (status == CP_OK) {
        table->strata = strata->count;
        table->clusters = clusters->count;
    }
    free(strata);
    free(clusters);
    return status;
}

static cp_status make_room(cp_field_table *table, size_t count, cp_error *error)
{
    table->count = count;
    table->weight = calloc(count + 1, sizeof *table->weight);
    table->type = calloc(count + 1, sizeof *table->type);
    table->stratum = calloc(count + 1, sizeof *table->stratum);
    table->cluster = calloc(count + 1, sizeof *table->cluster);
    bool made = table->weight && table->type && table->stratum && table->cluster;
    for (int v = 0; v < CP_FIELD_VALUE_COUNT; v++) {
        table->value[v] = calloc(count + 1, sizeof *table->value[v]);
        made = made && table->value[v];
    }
    return made ? CP_OK : cp_fail_memory(error, "a field table");
}

cp_status cp_field_table_read(const char *name_or_path, cp_field_table *table, cp_error *error)
{
    *table = (cp_field_table){0};
    cp_csv_table csv = {0};
    char *content = NULL;
    cp_status status = strcmp(name_or_path, "nass") == 0
                           ? unpack("nass", cp_field_nass, cp_field_nass_size, &content, error)
                           : read_text(name_or_path, &content, error);
    if (status != CP_OK) {
        free(content);
        return status;
    }
    table->bias = comment(content, "bias");
    table->name = comment(content, "name");
    if (!table->name)
        table->name = cp_text_copy_plain(name_or_path);
    status = cp_csv_table_parse(name_or_path, content, &csv, error);
    if (status == CP_OK)
        status = make_room(table, csv.row_count, error);
    if (status == CP_OK && !table->name)
        status = cp_fail_memory(error, "a field table");
    if (status == CP_OK)
        status = read_values(&csv, table, error);
    if (status == CP_OK)
        status = read_design(&csv, table, error);
    cp_csv_table_destroy(&csv);
    return status;
}

void cp_field_table_destroy(cp_field_table *table)
{
    free(table->name);
    free(table->bias);
    free(table->weight);
    free(table->type);
    free(table->stratum);
    free(table->cluster);
    for (int v = 0; v < CP_FIELD_VALUE_COUNT; v++)
        free(table->value[v]);
    *table = (cp_field_table){0};
}

// ---- shares ----------------------------------------------------------------------------------

unsigned char cp_field_table_class(const cp_field_table *table, size_t row, cp_field_margin margin)
{
    return margin == CP_FIELD_TYPE ? table->type[row]
           : margin == CP_FIELD_DELTA_V
               ? cp_field_delta_v_class(table->value[CP_FIELD_VALUE_DELTA_V][row])
               : cp_field_overlap_class(table->value[CP_FIELD_VALUE_OVERLAP][row]);
}

// Variance of a share: of the clusters' sums of w (1 - share or - share), within strata.
static double variance_of(const cp_field_table *table, cp_field_margin margin, size_t of,
                          double share_1, double total, double *sum, size_t *home)
{
    for (size_t c = 0; c < table->clusters; c++)
        sum[c] = 0.0;
    for (size_t k = 0; k < table->count; k++) {
        unsigned char own = cp_field_table_class(table, k, margin);
        home[table->cluster[k]] = table->stratum[k];
        if (own != CP_FIELD_UNKNOWN)
            sum[table->cluster[k]] += table->weight[k] * ((own == of) - share_1) / total;
    }
    double variance = 0.0;
    for (size_t s = 0; s < table->strata; s++) {
        double n = 0.0, mean = 0.0, squares = 0.0;
        for (size_t c = 0; c < table->clusters; c++) {
            n += home[c] == s;
            mean += home[c] == s ? sum[c] : 0.0;
        }
        for (size_t c = 0; c < table->clusters; c++)
            squares += home[c] == s ? (sum[c] - mean / n) * (sum[c] - mean / n) : 0.0;
        variance += n > 1.0 ? n / (n - 1.0) * squares : 0.0;
    }
    return variance;
}

cp_status cp_field_table_shares(const cp_field_table *table, cp_field_margin margin,
                                cp_field_share *share, cp_error *error)
{
    double total = 0.0;
    size_t classes = CP_FIELD_MARGIN_CLASSES[margin];
    double *sum = calloc(table->clusters + 1, sizeof *sum);
    size_t *home = calloc(table->clusters + 1, sizeof *home);
    if (!sum || !home) {
        free(sum);
        free(home);
        return cp_fail_memory(error, "shares of a field table");
    }
    for (size_t c = 0; c < classes; c++)
        share[c] = (cp_field_share){0.0, NAN};
    for (size_t k = 0; k < table->count; k++) {
        unsigned char own = cp_field_table_class(table, k, margin);
        if (own == CP_FIELD_UNKNOWN)
            continue;
        share[own].share_1 += table->weight[k];
        total += table->weight[k];
    }
    for (size_t c = 0; c < classes && total > 0.0; c++) {
        share[c].share_1 /= total;
        if (table->clusters > 1)
            share[c].se_1 = sqrt(variance_of(table, margin, c, share[c].share_1, total, sum, home));
    }
    free(sum);
    free(home);
    return CP_OK;
}
