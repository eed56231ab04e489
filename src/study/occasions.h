/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_OCCASIONS_H
#define STUDY_OCCASIONS_H

#include "study/study.h"

/* Tell by log which driver errors of the study cannot act for want of something in the network:
 * red_light without traffic lights, risky_overtaking without lanes that may overtake over the
 * oncoming one. Errors: those of cp_scenario_occasions_find. */
CP_MUST_CHECK cp_status cp_study_tell_occasions(const cp_study *study, cp_error *error);

#endif
