/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/scripted_road.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static void the_table_is_sound(void **unused)
{
    (void)unused;
    assert_true(CP_CONTROL_TYPE_COUNT >= 3);
    for (size_t k = 0; k < CP_CONTROL_TYPE_COUNT; k++) {
        const cp_control_type *type = CP_CONTROL_TYPE[k];
        assert_ptr_equal(cp_control_type_find(type->kind, type->name), type);
        assert_true(type->parameter_count <= CP_CONTROL_PARAMETERS_MAX);
        cp_control_settings settings = cp_control_settings_default(type);
        for (size_t i = 0; i < type->parameter_count; i++) {
            const cp_control_parameter *row = &type->parameters[i];
            assert_true(row->smallest <= row->standard && row->standard <= row->largest);
            assert_true(settings.parameter[i] == row->standard);
            assert_true(strlen(row->what) > 0);
            // Names carry their unit.
            assert_non_null(strchr(row->name, '_'));
        }
    }
    // A driver error is no function.
    assert_null(cp_control_type_find(CP_CONTROL_FUNCTION, "failed_to_see"));
    assert_null(cp_control_type_find(CP_CONTROL_DRIVER_ERROR, "aeb"));
    assert_null(cp_control_type_find(CP_CONTROL_FUNCTION, "autopilot"));
}

static void a_parameter_out_of_range_is_refused(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    const char *const names[] = {"ttc_s", NULL};
    const double values[] = {-1.0};
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "aeb", names, values);
    cp_controls *controls;
    cp_error error = {0};
    assert_int_equal(cp_controls_create(&settings, 1, 1, 1, traffic, &controls, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "ttc_s"));
    assert_non_null(strstr(error.text, "-1"));
    assert_null(controls);
    cp_traffic_destroy(traffic);
}

static void counters_come_as_one_object(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    road_add("one", 0.0, 0.0, 0.0, 10.0);
    cp_control_settings settings[2] = {
        road_settings(CP_CONTROL_DRIVER_ERROR, "failed_to_see", NULL, NULL),
        road_settings(CP_CONTROL_FUNCTION, "aeb", NULL, NULL)};
    cp_controls *controls;
    cp_error error = {0};
    assert_int_equal(cp_controls_create(settings, 2, 1, 1, traffic, &controls, &error), CP_OK);
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    assert_int_equal(cp_controls_step(controls, &error), CP_OK);
    char *json;
    assert_int_equal(cp_controls_counters_json(controls, &json, &error), CP_OK);
    assert_non_null(strstr(json, "{\"aeb.activations\":0.0,\"aeb.activations_crossing\":0.0,"));
    assert_non_null(strstr(json, "\"aeb.equipped_vehicles\":1.0,"
                                 "\"failed_to_see.overlooked_pairs\":0.0,"
                                 "\"failed_to_see.pairs\":0.0}"));
    free(json);
    cp_controls_destroy(controls);

    // None at all is fine, too.
    assert_int_equal(cp_controls_create(NULL, 0, 1, 1, traffic, &controls, &error), CP_OK);
    assert_int_equal(cp_controls_step(controls, &error), CP_OK);
    assert_false(cp_controls_is_at_fault(controls, 0));
    assert_int_equal(cp_controls_counters_json(controls, &json, &error), CP_OK);
    assert_string_equal(json, "{}");
    free(json);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_is_sound),
        cmocka_unit_test(a_parameter_out_of_range_is_refused),
        cmocka_unit_test(counters_come_as_one_object),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
