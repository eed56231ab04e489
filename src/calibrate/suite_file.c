/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite_file.h"

#include "calibrate/suite_schema.h"
#include "core/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- single values -----------------------------------------------------------------------------

// Where in the file we are: the key path of a class or of one of its comparisons.
typedef struct place {
    const cp_yaml_file *file;
    char path[96];
    cp_error *error;
} place;

static const char *key_at(const place *at, const char *key, char *text, size_t size)
{
    snprintf(text, size, "%s%s%s", at->path, at->path[0] != '\0' ? "." : "", key);
    return text;
}

static cp_status fail_at(const place *at, const char *key, const char *message, const char *found)
{
    char path[192];
    key_at(at, key, path, sizeof path);
    return found != NULL ? cp_yaml_fail(at->file, at->error, path, "%s, found '%s'", message, found)
                         : cp_yaml_fail(at->file, at->error, path, "%s", message);
}

static cp_status read_number(const place *at, const char *key, const char *text, double smallest,
                             double largest, double *value)
{
    char path[192];
    return cp_yaml_number(at->file, key_at(at, key, path, sizeof path), text, smallest, largest,
                          value, at->error);
}

static cp_status read_text(const place *at, const char *key, const char *text, char *copy,
                           size_t size)
{
    char message[64];
    snprintf(message, sizeof message, "must have 1 to %zu characters", size - 1);
    if (text[0] == '\0' || strlen(text) >= size)
        return fail_at(at, key, message, text);
    snprintf(copy, size, "%s", text);
    return CP_OK;
}

static cp_status read_truth(const place *at, const char *key, const char *text, bool *value)
{
    *value = text != NULL && strcmp(text, "yes") == 0;
    return text == NULL || *value || strcmp(text, "no") == 0
               ? CP_OK
               : fail_at(at, key, "must be yes or no", text);
}

static cp_status read_numbers(const place *at, const char *key, char *const *texts, unsigned count,
                              double smallest, double largest, cp_suite_numbers *numbers)
{
    if (count == 0)
        return CP_OK;
    numbers->value = calloc(count, sizeof *numbers->value);
    if (numbers->value == NULL)
        return cp_fail_memory(at->error, at->file->path);
    cp_status status = CP_OK;
    for (unsigned k = 0; status == CP_OK && k < count; k++) {
        char item[64];
        snprintf(item, sizeof item, "%s[%u]", key, k);
        status = read_number(at, item, texts[k], smallest, largest, &numbers->value[k]);
    }
    numbers->count = count;
    return status;
}

static cp_status copy_texts(const place *at, char *const *texts, unsigned count,
                            cp_suite_texts *copies)
{
    if (count == 0)
        return CP_OK;
    copies->text = calloc(count, sizeof *copies->text);
    if (copies->text == NULL)
        return cp_fail_memory(at->error, at->file->path);
    for (unsigned k = 0; k < count; k++) {
        copies->text[k] = strdup(texts[k]);
        if (copies->text[k] == NULL)
            return cp_fail_memory(at->error, at->file->path);
        copies->count++;
    }
    return CP_OK;
}

// ---- comparisons -------------------------------------------------------------------------------

static cp_status read_bar(const place *at, const cp_suite_yaml_bar *yaml, cp_suite_bar *bar)
{
    static const cp_suite_yaml_bar NONE = {0};
    *bar = (cp_suite_bar){.inside_1 = NAN,
                          .mean_abs = NAN,
                          .median_abs = NAN,
                          .p90_abs = NAN,
                          .max_abs = NAN,
                          .max_step = NAN};
    if (yaml == NULL)
        yaml = &NONE;
    const struct {
        const char *key;
        const char *text;
        double largest;
        double *value;
    } fields[] = {{"bar.inside_1", yaml->inside_1, 1.0, &bar->inside_1},
                  {"bar.mean_abs", yaml->mean_abs, 1e6, &bar->mean_abs},
                  {"bar.median_abs", yaml->median_abs, 1e6, &bar->median_abs},
                  {"bar.p90_abs", yaml->p90_abs, 1e6, &bar->p90_abs},
                  {"bar.max_abs", yaml->max_abs, 1e6, &bar->max_abs},
                  {"bar.max_step", yaml->max_step, 1e6, &bar->max_step}};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof fields / sizeof *fields; k++)
        status =
            read_number(at, fields[k].key, fields[k].text, 0.0, fields[k].largest, fields[k].value);
    if (status == CP_OK)
        status = read_truth(at, "bar.falling", yaml->falling, &bar->falling);
    if (status == CP_OK)
        status =
            read_truth(at, "bar.last_is_highest", yaml->last_is_highest, &bar->last_is_highest);
    return status;
}

// That what the bar is about is there.
static cp_status check_comparison(const place *at, const cp_suite_yaml_comparison *yaml,
                                  const cp_suite_comparison *comparison)
{
    const cp_suite_bar *bar = &comparison->bar;
    bool corridor = comparison->population[0] != '\0' || comparison->low.count > 0 ||
                    comparison->high.count > 0;
    if (cp_suite_quantity_is_timed(comparison->quantity) != (comparison->times_ms.count > 0))
        return fail_at(at, "times_ms",
                       comparison->times_ms.count > 0
                           ? "does not go with this quantity"
                           : "is missing: the quantity is taken at given instants",
                       comparison->times_ms.count > 0 ? yaml->quantity : NULL);
    if (comparison->population[0] != '\0' &&
        comparison->reference.count + comparison->low.count + comparison->high.count > 0)
        return fail_at(at, "population", "does not go with reference, low or high", NULL);
    if (!isnan(bar->inside_1) && !corridor)
        return fail_at(at, "bar.inside_1", "needs a population, low or high", NULL);
    return CP_OK;
}

static cp_status read_comparison(const place *at, const cp_suite_yaml_comparison *yaml,
                                 cp_suite_comparison *comparison)
{
    comparison->quantity = cp_suite_quantity_find(yaml->quantity);
    if (comparison->quantity == CP_SUITE_QUANTITY_COUNT)
        return fail_at(at, "quantity", "is none that a suite compares", yaml->quantity);
    cp_status status = read_numbers(at, "times_ms", yaml->times_ms, yaml->times_ms_count, 1.0,
                                    390.0, &comparison->times_ms);
    if (status == CP_OK && yaml->population != NULL)
        status = read_text(at, "population", yaml->population, comparison->population,
                           sizeof comparison->population);
    if (status == CP_OK)
        status = read_numbers(at, "reference", yaml->reference, yaml->reference_count, -1e6, 1e6,
                              &comparison->reference);
    if (status == CP_OK)
        status = read_numbers(at, "low", yaml->low, yaml->low_count, -1e6, 1e6, &comparison->low);
    if (status == CP_OK)
        status =
            read_numbers(at, "high", yaml->high, yaml->high_count, -1e6, 1e6, &comparison->high);
    if (status == CP_OK)
        status = read_truth(at, "relative", yaml->relative, &comparison->relative);
    if (status == CP_OK && yaml->car != NULL) {
        comparison->car = strcmp(yaml->car, "1") == 0 ? 1 : strcmp(yaml->car, "2") == 0 ? 2 : 0;
        if (comparison->car == 0)
            status = fail_at(at, "car", "must be 1 or 2", yaml->car);
    }
    if (status == CP_OK)
        status = read_bar(at, yaml->bar, &comparison->bar);
    return status == CP_OK ? check_comparison(at, yaml, comparison) : status;
}

// ---- classes -----------------------------------------------------------------------------------

static cp_status read_table(const place *at, const cp_suite_yaml_table *yaml, cp_suite_class *class)
{
    static const char *const FORM[] = {
#define FORM_TEXT(name, text) text,
        CP_SUITE_FORMS(FORM_TEXT)
#undef FORM_TEXT
    };
    class->form = CP_SUITE_LISTS;
    if (yaml == NULL)
        return CP_OK;
    int form = CP_SUITE_OLC;
    while (form < CP_SUITE_FORM_COUNT && strcmp(yaml->form, FORM[form]) != 0)
        form++;
    if (form == CP_SUITE_FORM_COUNT)
        return fail_at(at, "table.form",
                       "must be olc, separation, oblique, reconstructed or reconstructed_struck",
                       yaml->form);
    if ((yaml->file == NULL) == (yaml->references_file == NULL))
        return fail_at(at, "table", "needs either file or references_file", NULL);
    class->form = (cp_suite_form)form;
    class->is_reference = yaml->file == NULL;
    class->table_path = class->is_reference ? strdup(yaml->references_file)
                                            : cp_file_beside(at->file->path, yaml->file);
    if (class->table_path == NULL)
        return cp_fail_memory(at->error, at->file->path);
    bool chosen = form == CP_SUITE_SEPARATION || form == CP_SUITE_STRUCK;
    if (chosen != (yaml->rows_with_count > 0))
        return fail_at(at, "table.rows_with",
                       "names the barriers of form separation or the sides of form "
                       "reconstructed_struck, and goes with no other",
                       NULL);
    return copy_texts(at, yaml->rows_with, yaml->rows_with_count, &class->rows_with);
}

static cp_status read_barrier(const place *at, const cp_suite_yaml_barrier *yaml,
                              cp_suite_class *class)
{
    class->has_barrier = yaml != NULL;
    class->barrier = cp_barrier_default();
    if (yaml == NULL)
        return CP_OK;
    cp_barrier *barrier = &class->barrier;
    cp_status status =
        read_number(at, "barrier.width_m", yaml->width_m, 0.2, 20, &barrier->width_m);
    if (status == CP_OK)
        status = read_number(at, "barrier.depth_m", yaml->depth_m, 0.2, 20, &barrier->depth_m);
    double largest_m = 0.5 * fmin(barrier->width_m, barrier->depth_m);
    const struct {
        const char *key;
        const char *text;
        double smallest;
        double largest;
        double *value;
    } fields[] = {
        {"barrier.corner_radius_m", yaml->corner_radius_m, 0.0, largest_m,
         &barrier->corner_radius_m},
        {"barrier.mass_kg", yaml->mass_kg, 0.0, 1e5, &barrier->mass_kg},
        {"barrier.yaw_inertia_kg_m2", yaml->yaw_inertia_kg_m2, 50.0, 1e6,
         &barrier->yaw_inertia_kg_m2},
        {"barrier.face_m", yaml->face_m, 0.0, 2.0, &barrier->face_m},
        {"barrier.face_kn", yaml->face_kn, 5.0, 5000.0, &barrier->face_kn},
        {"barrier.face_bumper_m", yaml->face_bumper_m, 0.0, 1.0, &barrier->face_bumper_m},
        {"barrier.face_bumper_kn", yaml->face_bumper_kn, 5.0, 5000.0, &barrier->face_bumper_kn}};
    for (size_t k = 0; status == CP_OK && k < sizeof fields / sizeof *fields; k++)
        status = read_number(at, fields[k].key, fields[k].text, fields[k].smallest,
                             fields[k].largest, fields[k].value);
    cp_error problem = {0};
    if (status == CP_OK && cp_barrier_validate(barrier, &problem) != CP_OK)
        status = fail_at(at, "barrier", problem.text, NULL);
    return status;
}

// Evenly from one value to another.
static cp_status spread(const place *at, const char *key, const char *count_text, double from,
                        double to, cp_suite_numbers *numbers)
{
    char path[64];
    double count = 0.0;
    snprintf(path, sizeof path, "%s.count", key);
    cp_status status = read_number(at, path, count_text, 2, CP_SUITE_LIST_MAX, &count);
    if (status == CP_OK && count != floor(count))
        status = fail_at(at, path, "must be a whole number", count_text);
    if (status == CP_OK && numbers->count > 0)
        status = fail_at(at, key, "does not go with a list of the same", NULL);
    if (status != CP_OK)
        return status;
    numbers->value = calloc((size_t)count, sizeof *numbers->value);
    if (numbers->value == NULL)
        return cp_fail_memory(at->error, at->file->path);
    numbers->count = (size_t)count;
    for (size_t k = 0; k < numbers->count; k++)
        numbers->value[k] = from + (to - from) * (double)k / (count - 1.0);
    return CP_OK;
}

static cp_status read_sweep(const place *at, const cp_suite_yaml_sweep *yaml, cp_suite_class *class)
{
    double from_1 = 0.0, to_1 = 0.0;
    cp_status status = read_number(at, "overlap_sweep.from_1", yaml->from_1, 0.001, 1.0, &from_1);
    if (status == CP_OK)
        status = read_number(at, "overlap_sweep.to_1", yaml->to_1, 0.001, 1.0, &to_1);
    return status == CP_OK
               ? spread(at, "overlap_sweep", yaml->count, from_1, to_1, &class->overlaps_1)
               : status;
}

static cp_status read_places(const place *at, const cp_suite_yaml_places *yaml,
                             cp_suite_class *class)
{
    double from_mm = 0.0, to_mm = 0.0;
    cp_status status = read_number(at, "at_sweep.from_mm", yaml->from_mm, -8000, 8000, &from_mm);
    if (status == CP_OK)
        status = read_number(at, "at_sweep.to_mm", yaml->to_mm, -8000, 8000, &to_mm);
    return status == CP_OK ? spread(at, "at_sweep", yaml->count, from_mm, to_mm, &class->at_mm)
                           : status;
}

// "left" and "right" into +1 and -1.
static cp_status read_sides(const place *at, const cp_suite_yaml_class *yaml, cp_suite_class *class)
{
    class->sides_1.value = calloc(yaml->sides_count + 1, sizeof *class->sides_1.value);
    if (class->sides_1.value == NULL)
        return cp_fail_memory(at->error, at->file->path);
    class->sides_1.value[0] = 1.0;
    class->sides_1.count = yaml->sides_count > 0 ? yaml->sides_count : 1;
    for (unsigned k = 0; k < yaml->sides_count; k++) {
        bool left = strcmp(yaml->sides[k], "left") == 0;
        if (!left && strcmp(yaml->sides[k], "right") != 0)
            return fail_at(at, "sides", "must be left or right", yaml->sides[k]);
        class->sides_1.value[k] = left ? 1.0 : -1.0;
    }
    return CP_OK;
}

static cp_status read_struck(const place *at, const cp_suite_yaml_class *yaml,
                             cp_suite_class *class)
{
    class->is_struck = yaml->struck != NULL;
    class->is_struck_on_rear = class->is_struck && strcmp(yaml->struck, "rear") == 0;
    if (class->is_struck && !class->is_struck_on_rear && strcmp(yaml->struck, "side") != 0)
        return fail_at(at, "struck", "must be side or rear", yaml->struck);
    cp_status status =
        read_numbers(at, "struck_speeds_km_h", yaml->struck_speeds_km_h,
                     yaml->struck_speeds_km_h_count, 0, 300, &class->struck_speeds_km_h);
    if (status == CP_OK)
        status =
            read_numbers(at, "at_mm", yaml->at_mm, yaml->at_mm_count, -8000, 8000, &class->at_mm);
    if (status == CP_OK)
        status = read_numbers(at, "struck_forces_1", yaml->struck_forces_1,
                              yaml->struck_forces_1_count, 0.2, 3.0, &class->struck_forces_1);
    if (status == CP_OK && yaml->at_sweep != NULL)
        status = read_places(at, yaml->at_sweep, class);
    if (status != CP_OK)
        return status;
    bool about_struck =
        class->struck_speeds_km_h.count + class->at_mm.count + class->struck_forces_1.count > 0;
    if (!class->is_struck && about_struck)
        return fail_at(at, "struck",
                       "is missing: struck_speeds_km_h, at_mm and struck_forces_1 "
                       "need it",
                       NULL);
    if (class->struck_speeds_km_h.count > 0 &&
        class->struck_speeds_km_h.count != class->speeds_km_h.count)
        return fail_at(at, "struck_speeds_km_h", "needs one for each of speeds_km_h", NULL);
    if (class->is_struck && (class->overlaps_1.count > 0 || class->form != CP_SUITE_LISTS))
        return fail_at(at, "struck", "does not go with overlaps or a table", NULL);
    if (class->is_struck && (class->against.count > 0) == class->has_barrier)
        return fail_at(at, "struck", "needs against or barrier, one of the two", NULL);
    return CP_OK;
}

static cp_status read_lists(const place *at, const cp_suite_yaml_class *yaml, cp_suite_class *class)
{
    cp_status status = read_numbers(at, "speeds_km_h", yaml->speeds_km_h, yaml->speeds_km_h_count,
                                    0.5, 300, &class->speeds_km_h);
    if (status == CP_OK)
        status =
            read_numbers(at, "opponent_speeds_km_h", yaml->opponent_speeds_km_h,
                         yaml->opponent_speeds_km_h_count, 0, 300, &class->opponent_speeds_km_h);
    if (status == CP_OK)
        status = read_numbers(at, "overlaps_1", yaml->overlaps_1, yaml->overlaps_1_count, 0.001, 1,
                              &class->overlaps_1);
    if (status == CP_OK)
        status = read_numbers(at, "angles_deg", yaml->angles_deg, yaml->angles_deg_count, -60, 60,
                              &class->angles_deg);
    if (status == CP_OK && yaml->overlap_sweep != NULL)
        status = read_sweep(at, yaml->overlap_sweep, class);
    if (status == CP_OK)
        status = read_sides(at, yaml, class);
    return status == CP_OK ? read_struck(at, yaml, class) : status;
}

// That the class says what meets what, and nothing that its table says.
static cp_status check_class(const place *at, const cp_suite_yaml_class *yaml,
                             const cp_suite_class *class)
{
    bool by_lists = class->form == CP_SUITE_LISTS, pair = class->against.count > 0;
    bool listed = class->speeds_km_h.count + class->overlaps_1.count + class->angles_deg.count +
                      yaml->sides_count + class->against.count >
                  0;
    if (by_lists && class->speeds_km_h.count == 0)
        return fail_at(at, "speeds_km_h", "is missing: a class needs speeds or a table", NULL);
    if (!by_lists && listed && class->form != CP_SUITE_SEPARATION)
        return fail_at(at, "table",
                       "does not go with lists of speeds, overlaps, sides, angles or "
                       "opponents",
                       NULL);
    if (by_lists && !pair && !class->has_barrier)
        return fail_at(at, "barrier", "is missing: a class needs barrier, against or both", NULL);
    if (class->form == CP_SUITE_SEPARATION && !class->has_barrier)
        return fail_at(at, "barrier", "is missing: form separation needs it", NULL);
    bool party = class->is_struck || (class->has_barrier && cp_barrier_is_party(&class->barrier));
    if (pair && !class->is_struck && party)
        return fail_at(at, "barrier", "with a mass or a face does not go with against", NULL);
    if (class->opponent_speeds_km_h.count > 0 &&
        (!(pair || party) || class->is_struck ||
         class->opponent_speeds_km_h.count != class->speeds_km_h.count))
        return fail_at(at, "opponent_speeds_km_h", "needs against, and one for each of speeds_km_h",
                       NULL);
    for (size_t c = 0; c < class->comparison_count; c++) {
        cp_suite_quantity quantity = class->comparison[c].quantity;
        bool of_pair = cp_suite_quantity_is_of_pair(quantity);
        char key[64];
        snprintf(key, sizeof key, "compare[%zu].quantity", c);
        bool of_tests = class->form == CP_SUITE_OBLIQUE || class->form == CP_SUITE_RECONSTRUCTED ||
                        class->form == CP_SUITE_STRUCK;
        bool have_pair = pair || of_tests || party;
        if (class->comparison[c].car > 0 && !of_tests && !party)
            return fail_at(at, key, "of one car goes with struck or a table of pairs",
                           CP_SUITE_QUANTITY_TEXT[quantity]);
        if (of_pair && !have_pair)
            return fail_at(at, key, "needs a second car (against)",
                           CP_SUITE_QUANTITY_TEXT[quantity]);
        if (quantity == CP_SUITE_wall_difference_pct && (!class->has_barrier || party))
            return fail_at(at, key, "needs a barrier too", CP_SUITE_QUANTITY_TEXT[quantity]);
    }
    return CP_OK;
}

static cp_status read_class(const place *at, const cp_suite_yaml_class *yaml, cp_suite_class *class)
{
    cp_status status = read_text(at, "class", yaml->name, class->name, sizeof class->name);
    if (status == CP_OK)
        status = read_text(at, "title", yaml->title, class->title, sizeof class->title);
    if (status == CP_OK && yaml->note != NULL)
        status = read_text(at, "note", yaml->note, class->note, sizeof class->note);
    if (status == CP_OK)
        status = copy_texts(at, yaml->vehicles, yaml->vehicles_count, &class->vehicles);
    if (status == CP_OK)
        status = copy_texts(at, yaml->against, yaml->against_count, &class->against);
    if (status == CP_OK)
        status = read_table(at, yaml->table, class);
    if (status == CP_OK)
        status = read_barrier(at, yaml->barrier, class);
    if (status == CP_OK)
        status = read_lists(at, yaml, class);
    if (status != CP_OK)
        return status;
    class->comparison = calloc(yaml->compare_count, sizeof *class->comparison);
    if (class->comparison == NULL)
        return cp_fail_memory(at->error, at->file->path);
    for (unsigned c = 0; status == CP_OK && c < yaml->compare_count; c++) {
        place here = {.file = at->file, .error = at->error};
        snprintf(here.path, sizeof here.path, "%.60s.compare[%u]", at->path, c);
        class->comparison_count++;
        status = read_comparison(&here, &yaml->compare[c], &class->comparison[c]);
    }
    return status == CP_OK ? check_class(at, yaml, class) : status;
}

static cp_status read_classes(const cp_yaml_file *file, const cp_suite_yaml_suite *yaml,
                              cp_suite *suite, cp_error *error)
{
    suite->class = calloc(yaml->classes_count, sizeof *suite->class);
    if (suite->class == NULL)
        return cp_fail_memory(error, file->path);
    for (unsigned k = 0; k < yaml->classes_count; k++) {
        place here = {.file = file, .error = error};
        snprintf(here.path, sizeof here.path, "classes[%u]", k);
        suite->class_count++;
        cp_status status = read_class(&here, &yaml->classes[k], &suite->class[k]);
        for (unsigned before = 0; status == CP_OK && before < k; before++)
            if (strcmp(suite->class[before].name, suite->class[k].name) == 0)
                status = fail_at(&here, "class", "is given twice", suite->class[k].name);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

cp_status cp_suite_load(const char *path, cp_suite *suite, cp_error *error)
{
    *suite = (cp_suite){0};
    cp_yaml_file file = {0};
    cp_status status = cp_yaml_load(path, &CP_SUITE_YAML_VALUE, &file, error);
    if (status != CP_OK)
        return status;
    const cp_suite_yaml_suite *yaml = (const cp_suite_yaml_suite *)file.data;
    place here = {.file = &file, .error = error};
    suite->path = strdup(path);
    if (suite->path == NULL)
        status = cp_fail_memory(error, path);
    if (status == CP_OK)
        status = read_text(&here, "suite", yaml->suite, suite->name, sizeof suite->name);
    if (status == CP_OK && yaml->quantiles != NULL) {
        suite->quantiles_path = cp_file_beside(path, yaml->quantiles);
        if (suite->quantiles_path == NULL)
            status = cp_fail_memory(error, path);
    }
    if (status == CP_OK)
        status = copy_texts(&here, yaml->vehicles, yaml->vehicles_count, &suite->vehicles);
    if (status == CP_OK)
        status = read_classes(&file, yaml, suite, error);
    cp_yaml_close(&file);
    return status;
}
