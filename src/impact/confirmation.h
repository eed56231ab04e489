/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_CONFIRMATION_H
#define IMPACT_CONFIRMATION_H

#include "impact/touch.h"

#include <stdbool.h>

/* Whether a contact of rectangles is a crash, from the state at first touch alone: what driver,
 * assistance, SUMO or the handling of crashed cars does afterwards never decides. */
#define CP_CONFIRMATION_DEPTH_M 0.4
#define CP_CONFIRMATION_TIME_S 0.5
#define CP_CONFIRMATION_PATH_M 1.0
#define CP_CONFIRMATION_OVERLAP_1 0.1

/* Where the body is time_s later on a constant turn: its front's velocity turns with it. */
cp_rectangle cp_touching_body_later(const cp_touching_body *body, double time_s);

/* True when, both going on like that, the rectangles overlap at least 0.4 m deep: within 0.5 s, or,
 * where they meet at 0.8 m/s or more, within 1 m of relative path, so that a slow touch at an angle
 * counts like one straight on. */
bool cp_contact_goes_deep(const cp_touching_body body[2]);

/* How much of the two front edges meets: the length that both cover across the relative velocity of
 * the bodies, m; negative when they pass each other. What lies behind the edges takes no part: the
 * flank of a turned car is in the other's way, but not its front. */
double cp_front_edges_overlap_m(const cp_touching_body body[2]);

/* True for a crash: it goes deep, or it is front on front, at 0.8 m/s or more (slower nothing goes
 * deep in the time, at any angle), and the front edges meet over at least 10 % of the narrower
 * width. The same whichever body comes first. */
bool cp_contact_is_crash(const cp_touching_body body[2], const cp_first_touch *touch);

/* Width over which the other body lies in the way of a body that goes straight on: of its front
 * edge, what the other covers across its heading; <= 0 when it would pass. */
double cp_width_in_way_m(const cp_rectangle *moving, const cp_rectangle *other);

/* True when a body moves as no road vehicle can: its centre goes more than 20 degrees and 1.5 m/s
 * sideways of its heading, or it turns about a point nearer than half its length. */
bool cp_motion_is_impossible(const cp_touching_body *body);

/* The body as it would be without that: it goes along its heading and does not turn. */
cp_touching_body cp_touching_body_possible(const cp_touching_body *body);

#endif
