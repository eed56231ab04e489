/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_VEHICLE_CHOICE_H
#define CRASH_VEHICLE_CHOICE_H

#include <stdbool.h>
#include <stddef.h>

/* Which shipped vehicle stands for one that is known by class and size only.
 *
 * Rule: the first row of the table that has the class and holds every size. A size that is not
 * known does not count. A vehicle that no row holds has no model: it is not made a car of another
 * size, and trucks, buses, two-wheelers, rail and pedestrians have no model at all.
 *
 * Classes are SUMO's (vClass). "car" stands for passenger, private, taxi, evehicle, hov, vip
 * and authority. Height tells cars, SUVs and vans apart (SUMO's standard is 1.5 m);
 * the border between small and mid-size lies half way between the lengths of the two models. Camry
 * and mid_size are of the Accord's size and chosen by name only: the Accord has the wider
 * calibrated range. Lower bounds belong to the range, upper ones do not.
 *
 * X(vehicle, car, van, length from, to, width from, to, height from, to, mass from, to); lengths in
 * m, mass in kg, car and van: whether the row takes cars, and vans (delivery, emergency). */
#define CP_VEHICLE_CHOICES(X)                                                                      \
    X(small_car, true, false, 3.2, 4.43, 1.45, 1.95, 1.2, 1.65, 800, 1500)                         \
    X(honda_accord_2014, true, false, 4.43, 5.3, 1.6, 2.05, 1.2, 1.65, 1200, 2200)                 \
    X(suv, true, false, 4.3, 5.3, 1.7, 2.1, 1.65, 2.0, 1500, 2800)                                 \
    X(van, true, true, 4.6, 6.6, 1.75, 2.2, 1.65, 3.0, 1600, 3501)

typedef struct cp_vehicle_size {
    const char *vehicle_class; /* SUMO's vClass */
    double length_m;
    double width_m;
    double height_m; /* NAN: not known */
    double mass_kg;  /* NAN: not known */
} cp_vehicle_size;

#define CP_CHOICE_REASON_SIZE 160

/* Name of the shipped vehicle, static text; *is_car: of a row that takes cars only. NULL when none
 * fits; then reason says why. */
const char *cp_vehicle_choose(const cp_vehicle_size *size, bool *is_car,
                              char reason[CP_CHOICE_REASON_SIZE]);

#endif
