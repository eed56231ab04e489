/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/crash_library.h"

#include "builders/crash_builder.h"
#include "core/file.h"
#include "report/animation.h"

#include <jansson.h>
#include <string.h>
#include <unistd.h>

// A crash against the barrier, filmed or not.
typedef struct filmed_crash {
    cp_vehicle_model model;
    cp_crash_configuration configuration;
    cp_crash_description description;
    cp_crash_film film;
    cp_crash_result result;
} filmed_crash;

static void film_crash(filmed_crash *crash, const char *name, bool filmed)
{
    crash->model = cp_vehicle_model_default();
    snprintf(crash->model.name, sizeof crash->model.name, "%s", name);
    crash->configuration = crash_builder_configuration(&crash->model, NULL, 50.0, 0.0, 200.0, 10.0);
    cp_vec2 contact_m = cp_crash_contact_point(&crash->model, NULL, &crash->configuration);
    crash->description = cp_crash_describe(&crash->model, NULL, &crash->configuration, contact_m);
    crash->film = cp_crash_film_default();
    cp_crash_options options = cp_crash_options_default();
    options.film = filmed ? &crash->film : NULL;
    crash->result = crash_builder_simulate(&crash->model, NULL, &crash->configuration, &options);
}

static cp_animated_run animated(const filmed_crash *crash)
{
    return (cp_animated_run){.model = {&crash->model, NULL},
                             .configuration = &crash->configuration,
                             .description = &crash->description,
                             .result = &crash->result,
                             .film = &crash->film};
}

static void destroy(filmed_crash *crash)
{
    cp_crash_film_destroy(&crash->film);
    cp_crash_result_destroy(&crash->result);
}

static void the_page_carries_frames_and_pulses_of_its_runs(void **state)
{
    (void)state;
    filmed_crash one, two;
    film_crash(&one, "one</script>", true);
    film_crash(&two, "two", true);
    const cp_animated_run runs[2] = {animated(&one), animated(&two)};
    char path[] = "/tmp/animation_XXXXXX", *page = NULL;
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    cp_error error = {0};
    size_t size = 0;
    if (cp_animation_write(runs, 2, path, &error) != CP_OK ||
        cp_file_read(path, &page, &size, &error) != CP_OK)
        fail_msg("%s", error.text);
    unlink(path);

    // The data end at the first </script> after their beginning, and no name ends them early.
    const char *data = strstr(page, "id=\"data\">");
    assert_non_null(data);
    data += strlen("id=\"data\">");
    size_t length = (size_t)(strstr(data, "</script>") - data);
    json_t *json = json_loadb(data, length, 0, NULL);
    assert_non_null(json);
    json_t *list = json_object_get(json, "runs");
    assert_int_equal(json_array_size(list), 2);
    json_t *vehicle = json_array_get(json_object_get(json_array_get(list, 0), "vehicles"), 0);
    assert_string_equal(json_string_value(json_object_get(vehicle, "name")), "one</script>");
    assert_int_equal(json_array_size(json_object_get(vehicle, "poses")), one.film.frame_count);
    assert_int_equal(json_array_size(json_object_get(vehicle, "parts")), CP_FILM_PART_COUNT);
    json_t *speed = json_object_get(json_object_get(vehicle, "pulse"), "v_km_h");
    assert_int_equal(json_array_size(speed), one.result.pulse[0].sample_count);
    assert_float_equal(json_real_value(json_array_get(speed, 0)), 50.0, 1e-3);
    json_decref(json);
    free(page);
    destroy(&one);
    destroy(&two);
}

static void a_crash_nobody_filmed_is_refused(void **state)
{
    (void)state;
    filmed_crash crash;
    film_crash(&crash, "unseen", false);
    cp_animated_run run = animated(&crash);
    cp_error error = {0};
    assert_int_equal(cp_animation_write(&run, 1, "never.html", &error), CP_BAD_INPUT);
    assert_int_not_equal(access("never.html", F_OK), 0);
    destroy(&crash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_page_carries_frames_and_pulses_of_its_runs),
        cmocka_unit_test(a_crash_nobody_filmed_is_refused),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
