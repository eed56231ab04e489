/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/brake.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void loss_is_the_integral_of_ramp_and_plateau(void **unused)
{
    (void)unused;
    const cp_brake brake = {2.0, 40.0, 8.0, 0.0}; // ramp of 0.2 s
    assert_true(cp_brake_speed_loss_m_s(&brake, 1.0) == 0.0);
    assert_true(cp_brake_speed_loss_m_s(&brake, 2.0) == 0.0);
    assert_true(fabs(cp_brake_speed_loss_m_s(&brake, 2.1) - 0.2) < 1e-12);
    assert_true(fabs(cp_brake_speed_loss_m_s(&brake, 2.2) - 0.8) < 1e-12);
    assert_true(fabs(cp_brake_speed_loss_m_s(&brake, 3.2) - 8.8) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(loss_is_the_integral_of_ramp_and_plateau)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
