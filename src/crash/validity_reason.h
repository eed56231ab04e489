/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_VALIDITY_REASON_H
#define CRASH_VALIDITY_REASON_H

/* Whether one vehicle's crash lies inside what tests speak for (crash/validity.h): a set of what is
 * outside, 0 = inside. X(name, bit, text). */
#define CP_VALIDITY_REASONS(X)                                                                     \
    X(CP_OUTSIDE_SPEED, 0, "speed")                                                                \
    X(CP_OUTSIDE_OFFSET, 1, "offset")                                                              \
    X(CP_OUTSIDE_ANGLE, 2, "angle")                                                                \
    X(CP_OUTSIDE_OBLIQUE_VELOCITY, 3, "oblique_velocity")                                          \
    X(CP_OUTSIDE_CONTACT_SIDE, 4, "contact_side")                                                  \
    X(CP_OUTSIDE_OPPONENT_STRUCTURE, 5, "opponent_structure")                                      \
    X(CP_OUTSIDE_MODEL, 6, "model")                                                                \
    X(CP_OUTSIDE_DAMAGED, 7, "damaged")                                                            \
    X(CP_OUTSIDE_NO_MODEL, 8, "no_model")                                                          \
    X(CP_OUTSIDE_SIZE, 9, "size")                                                                  \
    X(CP_OUTSIDE_NO_CONTACT, 10, "no_contact")                                                     \
    X(CP_OUTSIDE_MOVED, 11, "moved")

enum {
#define CP_VALIDITY_NAME(name, bit, text) name = 1u << bit,
    CP_VALIDITY_REASONS(CP_VALIDITY_NAME)
#undef CP_VALIDITY_NAME
};

#endif
