/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_NETWORK_SURVEY_H
#define STUDY_NETWORK_SURVEY_H

#include "study/sumo_configuration.h"

#include <jansson.h>
#include <stddef.h>

/* What a scenario's networks and demand have that matters for a study of it. Counted in the files
 * that SUMO reads for it, included ones too; what is no XML has nothing. */
typedef struct cp_network_survey {
    size_t edges;            /* roads, one direction each, those inside junctions left out */
    size_t two_way;          /* of them with another that leads back between the same junctions */
    size_t lights;           /* traffic light programmes */
    size_t yielding;         /* connections that must give way to others without a light */
    size_t may_overtake;     /* lanes beside which the oncoming one may be used for overtaking */
    double speed_max_m_s;    /* fastest lane; 0 without one */
    double diagonal_m;       /* of the box around the network; 0: not known */
    size_t departures;       /* vehicles and trips */
    size_t flows;            /* flows of vehicles */
    double last_departure_s; /* of vehicles, trips and flows with an end, SUMO clock; -INFINITY
                                without any */
    json_t *types;           /* {id: vClass} of vehicle types; owned */
} cp_network_survey;

/* Zero-initialise; the caller destroys, after a failure too. Errors: CP_BAD_INPUT for a file that
 * cannot be read; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_network_survey_make(const cp_sumo_configuration *configuration,
                                               cp_network_survey *survey, cp_error *error);
void cp_network_survey_destroy(cp_network_survey *survey);

#endif
