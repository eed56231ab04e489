/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page.h"

#include "report/page_data.h"
#include "store/query.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "report/small_study.h"

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
    char *text = cp_page_data_text(page);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_filled_as_they_are),
        cmocka_unit_test(text_cannot_become_markup),
        cmocka_unit_test(data_is_safe_in_a_script_and_unchanged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
