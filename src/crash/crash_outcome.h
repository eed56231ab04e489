/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRASH_OUTCOME_H
#define CRASH_CRASH_OUTCOME_H

/* What a crash did to the structure of a car. */

/* What the parts of a car have dissipated, J. */
typedef struct cp_car_absorbed {
    double longitudinal_j; /* crush of the longitudinal members */
    double crash_box_j;    /* of the crash boxes with the bumper */
    double bending_j;      /* feet of the longitudinals, halves of the cross member */
    double engine_j;       /* cradle, firewall behind it, mounts with their dampers */
    double corner_j;       /* outboard corners with the cell's edge behind them */
    double upper_j;        /* upper load path likewise */
    double struck_j;       /* sides and rear of a car struck there; the face of a barrier */
    double rate_j;         /* what strain rate adds to all of them */
} cp_car_absorbed;

/* Where a car was struck. X(name, text) */
#define CP_STRUCK_ZONES(X)                                                                         \
    X(CP_STRUCK_FRONT, "front")                                                                    \
    X(CP_STRUCK_FRONT_WHEEL, "front_wheel")                                                        \
    X(CP_STRUCK_DOOR, "door")                                                                      \
    X(CP_STRUCK_REAR_WHEEL, "rear_wheel")                                                          \
    X(CP_STRUCK_REAR, "rear")
typedef enum cp_struck_zone {
#define CP_STRUCK_ZONE_NAME(name, text) name,
    CP_STRUCK_ZONES(CP_STRUCK_ZONE_NAME)
#undef CP_STRUCK_ZONE_NAME
} cp_struck_zone;
/* "front", "front_wheel", "door", "rear_wheel", "rear". */
const char *cp_struck_zone_text(cp_struck_zone zone);

/* How far a car was pushed in where it was struck, for good: a side or the rear from its outline,
 * a front into the passenger cell. */
typedef struct cp_struck {
    double depth_m;
    cp_struck_zone zone; /* of a side the one that took most energy */
} cp_struck;

#endif
