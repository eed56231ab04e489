/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <crashpulse.h>
#include <stdio.h>

int main(void)
{
    crashpulse_error error = {0};
    crashpulse_vehicle *car = NULL;
    crashpulse_crash *crash = NULL;
    crashpulse_meeting meeting = crashpulse_meeting_default();
    meeting.speed_m_s = 56.0 / 3.6;
    if (crashpulse_begin(&error) || crashpulse_vehicle_load("honda_accord_2014", &car, &error) ||
        crashpulse_simulate(car, NULL, &meeting, &crash, &error))
        return fprintf(stderr, "%s\n", error.text), 1;
    printf("%.17g\n", crashpulse_crash_severity(crash, 0).olc_g);
    crashpulse_crash_free(crash);
    crashpulse_vehicle_free(car);
    crashpulse_end();
    return 0;
}
