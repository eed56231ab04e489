/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <crashpulse.h>

#include <cstdio>

// OLC of an even deceleration of 20 g from 15 m/s: the occupant of the criterion ends at 20 g too,
// a little later.
int main()
{
    double velocity[200];
    for (int k = 0; k < 200; k++) {
        double v = 15.0 - 20.0 * 9.80665 * k * 0.001;
        velocity[k] = v > 0.0 ? v : 0.0;
    }
    const char *status = nullptr;
    double olc_g = crashpulse_olc_g(velocity, 200, 0.001, &status);
    std::printf("%s %.17g\n", status, olc_g);
    return 0;
}
