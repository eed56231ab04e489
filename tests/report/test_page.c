/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page.h"

#include "report/gallery.h"
#include "report/page_data.h"
#include "store/query.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "builders/small_study.h"

static void places_are_filled_as_they_are(void **state)
{
    (void)state;
    const cp_page_part parts[] = {{"a", "{{b}}"}, {"b", "2"}};
    char *page = NULL;
    size_t size = 0;
    cp_error error = {0};
    assert_int_equal(cp_page_fill("x{{a}}y{{b}}z", parts, 2, &page, &size, &error), CP_OK);
    // What a part holds is not filled again.
    assert_string_equal(page, "x{{b}}y2z");
    assert_int_equal(size, strlen(page));
    free(page);
    assert_int_equal(cp_page_fill("{{c}}", parts, 2, &page, &size, &error), CP_BAD_INPUT);
    assert_null(page);
}

static void text_cannot_become_markup(void **state)
{
    (void)state;
    char *escaped = cp_page_escape("<b a=\"1\">&</b>");
    assert_string_equal(escaped, "&lt;b a=&quot;1&quot;&gt;&amp;&lt;/b&gt;");
    free(escaped);
}

// Whatever stands in the study, no < reaches the script element, and JSON gives it back.
static void data_is_safe_in_a_script_and_unchanged(void **state)
{
    (void)state;
    cp_store *store = open_small_study();
    cp_study_data data;
    json_t *page = NULL;
    char *answer = NULL;
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 10, .permutations = 9};
    assert_int_equal(cp_study_data_read(store, &data, &error), CP_OK);
    assert_int_equal(cp_page_data(store, &data, 0, &options, &page, &answer, &error), CP_OK);
    char *text = cp_page_json_text(page);
    assert_non_null(text);
    assert_null(strpbrk(text, "<>&"));
    json_t *back = json_loads(text, 0, NULL);
    assert_non_null(back);
    const char *question =
        json_string_value(json_object_get(json_object_get(back, "study"), "question"));
    assert_non_null(strstr(question, "</script><script>"));
    assert_int_equal(json_array_size(json_object_get(back, "slices")), 3 * 4);

    // Ids of crashes have 63 bits, more than a script's numbers: they are text, and true.
    size_t place;
    json_t *entry;
    json_array_foreach(json_object_get(back, "gallery"), place, entry)
    {
        char sql[128];
        double there = 0.0;
        const char *id = json_string_value(json_object_get(entry, "crash_id"));
        assert_non_null(id);
        snprintf(sql, sizeof sql, "SELECT count(*) FROM crash WHERE id = %.40s", id);
        assert_int_equal(cp_query_number(store, sql, &there, &error), CP_OK);
        assert_true(there == 1.0);
    }
    assert_int_equal(json_array_size(json_object_get(back, "gallery")), 4);
    json_decref(back);
    free(text);
    json_decref(page);
    free(answer);
    cp_study_data_destroy(&data);
    cp_store_close(store);
}

/* Rows of a query shown on the page, against what the page draws. */
typedef struct shown_rows {
    const json_t *page;
    const char *figure;
    size_t count;
} shown_rows;

static const json_t *at(const json_t *array, size_t place)
{
    return json_array_get(array, place);
}

// The first slice is that of everything.
static void check_rate(const shown_rows *shown, const cp_row *row)
{
    const json_t *variants =
        json_object_get(at(json_object_get(shown->page, "slices"), 0), "variants");
    const json_t *own = at(variants, shown->count);
    const json_t *rate = json_object_get(own, "frontal_crashes_per_million_km");
    assert_string_equal(row->cell[0].text, json_string_value(json_object_get(own, "variant")));
    assert_true(row->cell[4].integer ==
                json_integer_value(json_object_get(own, "frontal_crashes")));
    assert_true(fabs(row->cell[5].real - json_real_value(json_object_get(rate, "value"))) < 1e-6);
}

// Some vehicle of role a that is drawn lies there.
static void check_point(const shown_rows *shown, const cp_row *row)
{
    const json_t *vehicles = json_object_get(shown->page, "vehicles");
    const json_t *names = json_object_get(shown->page, "variants");
    size_t count = json_array_size(json_object_get(vehicles, "variant")), found = 0;
    for (size_t k = 0; k < count; k++) {
        size_t v = (size_t)json_integer_value(at(json_object_get(vehicles, "variant"), k));
        const char *name = json_string_value(json_object_get(at(names, v), "name"));
        double offset_m = json_number_value(at(json_object_get(vehicles, "lateral_offset_m"), k));
        double angle_deg = json_number_value(at(json_object_get(vehicles, "angle_deg"), k));
        found += strcmp(name, row->cell[0].text) == 0 &&
                 json_integer_value(at(json_object_get(vehicles, "role"), k)) == 0 &&
                 fabs(offset_m - row->cell[3].real) < 1e-3 &&
                 fabs(angle_deg - row->cell[4].real) < 1e-2;
    }
    assert_true(found > 0);
}

static cp_status check_row(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    shown_rows *shown = context;
    if (strcmp(shown->figure, "crash_rates") == 0)
        check_rate(shown, row);
    else
        check_point(shown, row);
    shown->count++;
    return CP_OK;
}

// The SQL under a figure gives what the figure shows.
static void the_sql_under_a_figure_is_its(void **state)
{
    (void)state;
    cp_store *store = open_small_study();
    cp_study_data data;
    json_t *page = NULL;
    char *answer = NULL;
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 10, .permutations = 9};
    assert_int_equal(cp_study_data_read(store, &data, &error), CP_OK);
    assert_int_equal(cp_page_data(store, &data, 0, &options, &page, &answer, &error), CP_OK);
    static const char *const FIGURE[] = {"crash_rates", "configuration_points"};
    size_t frontal = 0, rows[2] = {0, 0}, place;
    for (size_t k = 0; k < data.crash_count; k++)
        frontal += data.crash[k].frontal;
    for (int f = 0; f < 2; f++) {
        const json_t *query;
        json_array_foreach(json_object_get(page, "queries"), place, query)
        {
            if (strcmp(json_string_value(json_object_get(query, "name")), FIGURE[f]) != 0)
                continue;
            shown_rows shown = {page, FIGURE[f], 0};
            cp_query_handler handler = {.row = check_row, .context = &shown};
            const char *sql = json_string_value(json_object_get(query, "sql"));
            assert_int_equal(cp_query(store, sql, NULL, 0, &handler, &error), CP_OK);
            rows[f] = shown.count;
        }
    }
    assert_int_equal(rows[0], data.variant_count);
    assert_int_equal(rows[1], frontal);
    json_decref(page);
    free(answer);
    cp_study_data_destroy(&data);
    cp_store_close(store);
}

// The entry of a variant whose reason begins so; NULL without one.
static const json_t *entry_of(const json_t *gallery, const char *variant, const char *why)
{
    size_t place;
    const json_t *entry;
    json_array_foreach(gallery, place, entry)
    {
        const char *own = json_string_value(json_object_get(entry, "variant"));
        const char *reason = json_string_value(json_object_get(entry, "why"));
        if (strcmp(own, variant) == 0 && strncmp(reason, why, strlen(why)) == 0)
            return entry;
    }
    return NULL;
}

// The gallery's median counts left-censored vehicles, as every other median does; one that is
// itself left-censored is not shown.
static void the_median_of_the_gallery_counts_the_censored(void **state)
{
    (void)state;
    cp_store *store = open_small_study();
    cp_study_data data;
    cp_error error = {0};
    assert_int_equal(cp_study_data_read(store, &data, &error), CP_OK);
    for (int share = 3; share >= 1;
         share--) { // every third, every second, all but one are censored
        double *olc_g = calloc(data.vehicle_count, sizeof *olc_g);
        size_t count = 0, known = 0;
        for (size_t k = 0; k < data.vehicle_count; k++) {
            cp_study_vehicle *v = &data.vehicle[k];
            bool own = data.replication[data.crash[v->crash].replication].variant == 0;
            if (!own || !v->frontal || v->validity != 0 || v->olc == CP_OLC_FAILED)
                continue;
            if (v->olc == CP_OLC_KNOWN && known > 0 && count % (size_t)share == 0)
                v->olc = CP_OLC_CENSORED;
            known += v->olc == CP_OLC_KNOWN;
            olc_g[count++] = v->olc == CP_OLC_KNOWN ? v->olc_g : -INFINITY;
        }
        gsl_sort(olc_g, 1, count);
        json_t *gallery = NULL;
        assert_int_equal(cp_gallery_json(store, &data, &gallery, &error), CP_OK);
        const json_t *median = entry_of(gallery, data.variant[0].name, "the median OLC");
        const json_t *highest = entry_of(gallery, data.variant[0].name, "the highest OLC");
        double middle_g = olc_g[(count - 1) / 2];
        assert_true(count > 10);
        assert_int_equal(median != NULL, isfinite(middle_g));
        if (median)
            assert_true(json_real_value(json_object_get(median, "olc_g")) == middle_g);
        assert_non_null(highest);
        assert_true(json_real_value(json_object_get(highest, "olc_g")) == olc_g[count - 1]);
        json_decref(gallery);
        free(olc_g);
    }
    cp_study_data_destroy(&data);
    cp_store_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_filled_as_they_are),
        cmocka_unit_test(text_cannot_become_markup),
        cmocka_unit_test(data_is_safe_in_a_script_and_unchanged),
        cmocka_unit_test(the_median_of_the_gallery_counts_the_censored),
        cmocka_unit_test(the_sql_under_a_figure_is_its),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
