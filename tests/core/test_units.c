/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"

static void units_convert_and_back(void **state)
{
    (void)state;
    assert_near(cp_m_s_from_km_h(56.0), 15.5555555555555556, 1e-14);
    assert_near(cp_km_h_from_m_s(10.0), 36.0, 0.0);
    assert_near(cp_rad_from_deg(180.0), CP_PI, 0.0);
    assert_near(cp_deg_from_rad(CP_PI / 6.0), 30.0, 1e-14);
    assert_near(CP_G0_M_S2, 9.80665, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(units_convert_and_back)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
