/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/crash_export.h"

#include "core/file_stream.h"
#include "core/output_folder.h"
#include "core/progress.h"
#include "exchange/crash_sites.h"
#include "exchange/iso_mme.h"
#include "store/query.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <string.h>

static const struct {
    const char *word;
    bool has_pulses;
    bool is_folder;
} FORMAT[] = {
#define FORMAT_ROW(name, word, pulses, folder) {word, pulses, folder},
    CP_EXPORT_FORMATS(FORMAT_ROW)
#undef FORMAT_ROW
};

cp_export_format cp_export_format_find(const char *word)
{
    int k = 0;
    while (k < CP_EXPORT_FORMAT_COUNT && strcmp(FORMAT[k].word, word) != 0)
        k++;
    return (cp_export_format)k;
}

bool cp_export_has_pulses(cp_export_format format)
{
    return FORMAT[format].has_pulses;
}

// An export under way: a file or a folder.
typedef struct exporting {
    const cp_export_options *options;
    cp_export_count *count;
    cp_file_stream file;
    cp_output_folder folder;
    bool is_folder;
    const bool *known; // channels of the one pulse; NULL: all
    cp_network_projection *projection;
    cp_progress progress;
    size_t visited;
} exporting;

// ---- CSV -----------------------------------------------------------------------------------

// known (NULL: all): of the channels, each a column.
static void begin_table(FILE *file, const bool *known)
{
    fputs("crash_id,treatment,vehicle,contact_side,separation_s,time_s", file);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        if (known == NULL || known[c])
            fprintf(file, ",%s", CP_PULSE_COLUMN[c]);
    fputc('\n', file);
}

// A field of text between quotes; quotes, separators and control characters in it as '_': names of
// treatments are words of a study file.
static void write_word(FILE *file, const char *word)
{
    for (const char *c = word; *c != '\0'; c++)
        fputc(strchr("\"',;=+-@", *c) != NULL && (c == word || strchr("\",;", *c) != NULL) ? '_'
              : (unsigned char)*c < ' '                                                    ? '_'
                                                                                           : *c,
              file);
}

static void write_table(FILE *file, const char *crash, const char *treatment, const char *role,
                        const cp_pulse_record *record)
{
    const cp_pulse *pulse = &record->pulse;
    for (size_t k = 0; k < pulse->sample_count; k++) {
        fprintf(file, "%s,", crash);
        write_word(file, treatment);
        fprintf(file, ",%s,%s,", role, record->side);
        if (isfinite(record->separation_s))
            fprintf(file, "%.9g", record->separation_s);
        fprintf(file, ",%.9g", (double)k * pulse->sample_interval_s);
        for (int c = 0; c < CP_CHANNEL_COUNT; c++)
            if (record->known[c])
                fprintf(file, ",%.10g", pulse->channel[c][k]);
        fputc('\n', file);
    }
}

// ---- one crash -----------------------------------------------------------------------------

static void crash_name(const cp_selected_crash *crash, char name[64])
{
    snprintf(name, 64, "crash_%" PRId64, crash->id);
}

static void crash_title(const cp_selected_crash *crash, char title[512])
{
    snprintf(title, 512, "crash %" PRId64 " of %.100s and %.100s, scenario %.100s, %s%.100s",
             crash->id, crash->vehicle[0].sumo_id, crash->vehicle[1].sumo_id, crash->scenario,
             crash->treatment[0] != '\0' ? "treatment " : "variant ",
             crash->treatment[0] != '\0' ? crash->treatment : crash->variant);
}

static cp_status write_test(const exporting *self, const cp_selected_crash *crash, cp_error *error)
{
    char name[64], title[512];
    cp_iso_mme_test test = {
        .name = name, .title = title, .laboratory = self->options->program, .object_count = 2};
    crash_name(crash, name);
    crash_title(crash, title);
    for (int v = 0; v < 2; v++)
        test.object[v] = (cp_iso_mme_object){.name = crash->vehicle[v].vehicle_model,
                                             .record = &crash->vehicle[v].record,
                                             .filter = 'C'};
    return cp_iso_mme_write(self->folder.temporary, &test, error);
}

static void write_curves(FILE *file, const cp_unit_system *units, const cp_selected_crash *crash)
{
    enum { FIRST_ID = 1001 };
    char title[512];
    long next_id = FIRST_ID;
    crash_title(crash, title);
    cp_lsdyna_begin(file, title, units);
    for (int v = 0; v < 2; v++)
        cp_lsdyna_write(file, &crash->vehicle[v].record, v == 0 ? "a" : "b", units, next_id,
                        &next_id);
    cp_lsdyna_end(file);
}

static cp_status write_curve_file(const exporting *self, const cp_selected_crash *crash,
                                  cp_error *error)
{
    char path[PATH_MAX], name[64];
    FILE *file = NULL;
    crash_name(crash, name);
    if (snprintf(path, sizeof path, "%s/%s.k", self->folder.temporary, name) >= PATH_MAX)
        return cp_fail(error, CP_BAD_INPUT, "%.200s...: the path is too long", path);
    cp_status status = cp_output_folder_create(path, &file, error);
    if (status != CP_OK)
        return status;
    write_curves(file, self->options->units, crash);
    return cp_output_folder_close(path, file, error);
}

static cp_status write_crash(exporting *self, const cp_selected_crash *crash, cp_error *error)
{
    char id[32];
    snprintf(id, sizeof id, "%" PRId64, crash->id);
    switch (self->options->format) {
    case CP_EXPORT_ISO_MME:
        return write_test(self, crash, error);
    case CP_EXPORT_LSDYNA:
        if (self->is_folder)
            return write_curve_file(self, crash, error);
        write_curves(self->file.file, self->options->units, crash);
        return CP_OK;
    case CP_EXPORT_CSV:
        for (int v = 0; v < 2; v++)
            write_table(self->file.file, id, crash->treatment, v == 0 ? "a" : "b",
                        &crash->vehicle[v].record);
        return CP_OK;
    case CP_EXPORT_SUMO_POI:
        cp_sumo_poi_write(self->file.file, crash);
        return CP_OK;
    case CP_EXPORT_GEOJSON:
        return cp_geojson_write(self->file.file, crash, self->projection, self->count->crashes,
                                error);
    case CP_EXPORT_FORMAT_COUNT:
        break;
    }
    return CP_OK;
}

static cp_status visit(void *context, const cp_selected_crash *crash, cp_error *error)
{
    exporting *self = context;
    cp_status status = CP_OK;
    bool has_pulses = crash->vehicle[0].has_pulse && crash->vehicle[1].has_pulse;
    if (cp_export_has_pulses(self->options->format) && !has_pulses) {
        self->count->without_pulse++;
    } else {
        status = write_crash(self, crash, error);
        self->count->crashes++;
    }
    // A disk that is full is told at once, not after the rest.
    if (status == CP_OK && self->file.file != NULL && ferror(self->file.file))
        status = cp_fail(error, CP_IO_FAILED, "%s: cannot be written", self->options->output_path);
    cp_progress_update(&self->progress, ++self->visited, NULL);
    return status;
}

// ---- the whole -----------------------------------------------------------------------------

static cp_status check_network(exporting *self, cp_error *error)
{
    const cp_export_options *o = self->options;
    if (o->format != CP_EXPORT_GEOJSON || o->in_plane)
        return CP_OK;
    cp_status status = cp_network_projection_read(o->network_path, &self->projection, error);
    if (status == CP_OK && self->projection == NULL)
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: tells no projection (projParameter of its location), so its places "
                         "have no longitude and latitude",
                         o->network_path);
    return status;
}

static cp_status take_count(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    *(int64_t *)context = row->cell[0].integer;
    return CP_OK;
}

// A map is of one network: places of several would lie on each other.
static cp_status check_one_network(cp_store *store, const char *scenario,
                                   const cp_export_options *options, cp_error *error)
{
    int64_t networks = 0;
    cp_cell name = cp_cell_text(scenario);
    cp_query_handler handler = {.row = take_count, .context = &networks};
    if (cp_export_has_pulses(options->format))
        return CP_OK;
    cp_status status = cp_query(
        store,
        "SELECT count(DISTINCT f.value) FROM scenario AS s, json_each(s.files) AS f WHERE f.key "
        "LIKE '%.net.xml%' AND (?1 IS NULL OR s.name = ?1)",
        &name, 1, &handler, error);
    if (status == CP_OK && networks > 1)
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: its scenarios lie on %lld networks: choose one (--scenario NAME)",
                         cp_store_path(store), (long long)networks);
    return status;
}

static cp_status begin(exporting *self, cp_error *error)
{
    const char *path = self->options->output_path;
    cp_status status = check_network(self, error);
    if (status != CP_OK)
        return status;
    status = self->is_folder ? cp_output_folder_begin(path, &self->folder, error)
                             : cp_file_stream_begin(path, &self->file, error);
    if (status != CP_OK)
        return status;
    if (self->options->format == CP_EXPORT_CSV)
        begin_table(self->file.file, self->known);
    else if (self->options->format == CP_EXPORT_SUMO_POI)
        cp_sumo_poi_begin(self->file.file);
    else if (self->options->format == CP_EXPORT_GEOJSON)
        cp_geojson_begin(self->file.file, self->projection);
    return CP_OK;
}

static cp_status end(exporting *self, cp_error *error)
{
    if (self->options->format == CP_EXPORT_SUMO_POI)
        cp_sumo_poi_end(self->file.file);
    else if (self->options->format == CP_EXPORT_GEOJSON)
        cp_geojson_end(self->file.file);
    return self->is_folder ? cp_output_folder_commit(&self->folder, error)
                           : cp_file_stream_commit(&self->file, error);
}

static void clean_up(exporting *self)
{
    cp_network_projection_destroy(self->projection);
    cp_file_stream_abandon(&self->file);
    cp_output_folder_abandon(&self->folder);
}

cp_status cp_export_crashes(cp_store *store, const cp_crash_selection *selection,
                            const cp_export_options *options, cp_export_count *count,
                            cp_error *error)
{
    *count = (cp_export_count){0};
    exporting self = {.options = options,
                      .count = count,
                      .is_folder =
                          FORMAT[options->format].is_folder ||
                          (options->format == CP_EXPORT_LSDYNA && selection->crash_id < 0)};
    size_t selected = 0;
    cp_crash_selection own = *selection;
    own.with_pulses = cp_export_has_pulses(options->format);
    cp_status status = cp_crash_selection_count(store, &own, &selected, error);
    if (status == CP_OK && selected == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: has no such crash", cp_store_path(store));
    if (status == CP_OK)
        status = check_one_network(store, selection->scenario, options, error);
    if (status == CP_OK)
        status = begin(&self, error);
    if (status == CP_OK) {
        cp_progress_begin(&self.progress, "exporting", selected);
        status = cp_crash_selection_visit(store, &own, visit, &self, error);
        cp_progress_end(&self.progress);
    }
    if (status == CP_OK && count->crashes == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: none of the %zu crashes has its pulses stored",
                         cp_store_path(store), selected);
    if (status == CP_OK)
        status = end(&self, error);
    clean_up(&self);
    return status;
}

cp_status cp_export_pulse(const cp_pulse_record *record, const cp_export_options *options,
                          cp_error *error)
{
    exporting self = {.options = options,
                      .is_folder = options->format == CP_EXPORT_ISO_MME,
                      .known = record->known};
    long next_id = 0;
    cp_iso_mme_test test = {.name = "pulse",
                            .title = record->source,
                            .laboratory = options->program,
                            .object_count = 1,
                            .object = {{"NOVALUE", record, '0'}}};
    cp_status status = begin(&self, error);
    if (status == CP_OK && options->format == CP_EXPORT_ISO_MME)
        status = cp_iso_mme_write(self.folder.temporary, &test, error);
    else if (status == CP_OK && options->format == CP_EXPORT_LSDYNA) {
        cp_lsdyna_begin(self.file.file, record->source, options->units);
        cp_lsdyna_write(self.file.file, record, "a", options->units, 1001, &next_id);
        cp_lsdyna_end(self.file.file);
    } else if (status == CP_OK)
        write_table(self.file.file, "", "", "a", record);
    if (status == CP_OK)
        status = end(&self, error);
    clean_up(&self);
    return status;
}
