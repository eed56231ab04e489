/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/network.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const char NET[] =
    "<?xml version=\"1.0\"?>\n<!-- <lane shape=\"9,9 9,9\"/> -->\n<net version=\"1.9\">\n"
    "<edge id=\":j\" function=\"internal\"><lane id=\":j_0\" index=\"0\" shape=\"5,5 "
    "6,6\"/></edge>\n"
    "<edge id=\"a\" from=\"x\"><lane id=\"a_0\" index=\"0\" speed=\"13.9\"\n shape=\"0.00,1.25 "
    "10.04,-2.5,3.0\"/><lane id=\"a_1\" index=\"1\" shape=\"0,4 10,4 20,4\"/></edge>\n</net>\n";

static void lanes_are_read_without_heights_and_comments(void **state)
{
    (void)state;
    json_t *lanes = cp_network_lanes(NET, 100);
    assert_int_equal(json_array_size(lanes), 3);
    json_t *a0 = json_array_get(lanes, 1);
    const double wanted[] = {0.0, 1.3, 10.0, -2.5};
    assert_int_equal(json_array_size(a0), 4);
    for (size_t k = 0; k < 4; k++)
        assert_true(json_number_value(json_array_get(a0, k)) == wanted[k]);
    json_decref(lanes);
}

static void large_networks_are_thinned_out(void **state)
{
    (void)state;
    json_t *lanes = cp_network_lanes(NET, 5); // internal lanes go first
    assert_int_equal(json_array_size(lanes), 2);
    json_decref(lanes);
    lanes = cp_network_lanes(NET, 4); // then all but the first of an edge
    assert_int_equal(json_array_size(lanes), 1);
    json_decref(lanes);
}

static void broken_text_gives_what_is_whole(void **state)
{
    (void)state;
    json_t *lanes = cp_network_lanes("<net><lane shape=\"1,2 x\"/><lane shape=\"3", 100);
    assert_int_equal(json_array_size(lanes), 1);
    assert_int_equal(json_array_size(json_array_get(lanes, 0)), 2);
    json_decref(lanes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_are_read_without_heights_and_comments),
        cmocka_unit_test(large_networks_are_thinned_out),
        cmocka_unit_test(broken_text_gives_what_is_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
