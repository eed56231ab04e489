/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_VEHICLE_CHOICE_H
#define CRASH_VEHICLE_CHOICE_H

#include <stdbool.h>
#include <stddef.h>

/* Which shipped vehicle stands for one that is known by class and size only.
 *
 * Rule: the first row of the table that takes the class and holds every size. A size that is not
 * known does not count. A vehicle that no row holds has no model: it is not made a car of another
 * size, and two-wheelers, rail and pedestrians have no model at all.
 *
 * Classes are SUMO's (vClass). "car" stands for passenger, private, taxi, evehicle, hov, vip
 * and authority; "van" for delivery and emergency; "truck" for truck and trailer; "bus" for bus
 * and coach. Height tells cars, SUVs and vans apart (SUMO's standard is 1.5 m); the border between
 * small and mid-size lies half way between the lengths of the two models. Camry and mid_size are of
 * the Accord's size and chosen by name only: the Accord has the wider calibrated range. Lower
 * bounds belong to the range, upper ones do not.
 *
 * X(vehicle, takes, length from, to, width from, to, height from, to, mass from, to); lengths in
 * m, mass in kg. */
#define CP_VEHICLE_CHOICES(X)                                                                      \
    X(small_car, CP_TAKES_CAR, 3.2, 4.43, 1.45, 1.95, 1.2, 1.65, 800, 1500)                        \
    X(honda_accord_2014, CP_TAKES_CAR, 4.43, 5.3, 1.6, 2.05, 1.2, 1.65, 1200, 2200)                \
    X(suv, CP_TAKES_CAR, 4.3, 5.3, 1.7, 2.1, 1.65, 2.0, 1500, 2800)                                \
    X(van, CP_TAKES_CAR | CP_TAKES_VAN, 4.6, 6.6, 1.75, 2.2, 1.65, 3.0, 1600, 3501)                \
    CP_HEAVY_CHOICES(X)

/* Over 3.5 t. The same rows serve a fleet. */
#define CP_HEAVY_CHOICES(X)                                                                        \
    X(delivery_van, CP_TAKES_VAN, 5.5, 9.0, 1.9, 2.55, 2.0, 3.6, 3501, 7501)                       \
    X(rigid_truck, CP_TAKES_TRUCK, 5.0, 12.5, 2.0, 2.65, 2.0, 4.2, 3501, 32001)                    \
    X(tractor_trailer, CP_TAKES_TRUCK, 12.5, 19.0, 2.3, 2.65, 2.5, 4.2, 7501, 44001)               \
    X(bus, CP_TAKES_BUS, 7.0, 19.0, 2.1, 2.65, 2.5, 4.5, 5001, 32001)

/* The vehicle classes of a fleet (db/vehicles/fleet): rows that overlap are drawn from by their
 * shares. X(vehicle, as above, share). The shares of light classes are those of vehicles in towed
 * frontal crashes of the United States, 2010 to 2015 (db/vehicles/fleet/classes.csv); the rows of
 * the heavy ones do not overlap. */
#define CP_FLEET_CLASSES(X)                                                                        \
    X(small_car, CP_TAKES_CAR, 2.5, 4.3, 1.4, 1.95, 1.2, 1.65, 600, 1700, 0.144)                   \
    X(compact_car, CP_TAKES_CAR, 4.15, 4.72, 1.55, 1.95, 1.2, 1.65, 900, 2000, 0.217)              \
    X(mid_size_car, CP_TAKES_CAR, 4.5, 5.05, 1.6, 2.0, 1.2, 1.65, 1100, 2300, 0.193)               \
    X(large_car, CP_TAKES_CAR, 4.8, 5.4, 1.65, 2.1, 1.2, 1.65, 1300, 2600, 0.078)                  \
    X(suv, CP_TAKES_CAR, 4.0, 5.35, 1.65, 2.15, 1.65, 2.0, 1200, 2900, 0.228)                      \
    X(pickup, CP_TAKES_CAR, 5.35, 6.6, 1.75, 2.2, 1.65, 2.1, 1600, 3501, 0.076)                    \
    X(van, CP_TAKES_CAR | CP_TAKES_VAN, 4.4, 6.6, 1.7, 2.2, 1.65, 3.0, 1400, 3501, 0.065)

typedef enum cp_vehicle_takes {
    CP_TAKES_CAR = 1,
    CP_TAKES_VAN = 2,
    CP_TAKES_TRUCK = 4,
    CP_TAKES_BUS = 8
} cp_vehicle_takes;

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

/* Whether a name is that of a vehicle class of a fleet. */
bool cp_vehicle_is_fleet_class(const char *name);
const char *cp_vehicle_fleet_classes(void); /* all names, static text for messages */

/* The vehicle class of a fleet for a vehicle of that class and size: drawn by uniform_1 in [0, 1)
 * among the rows that hold it, by their shares in the order of the table. NULL when none fits; then
 * reason says why. */
const char *cp_vehicle_draw_class(const cp_vehicle_size *size, double uniform_1,
                                  char reason[CP_CHOICE_REASON_SIZE]);

#endif
