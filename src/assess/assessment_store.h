/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ASSESS_ASSESSMENT_STORE_H
#define ASSESS_ASSESSMENT_STORE_H

#include "assess/assessment.h"

/* Write an assessment to the new database of its request, as a study of one scenario and one
 * variant that has been run; one that holds the same crashes already stays as it is. Fills what
 * results do not know of their replication. Errors: CP_BAD_INPUT when two vehicle files have one
 * name; those of the store. */
CP_MUST_CHECK cp_status cp_assessment_store(cp_assessment *assessment, cp_error *error);

#endif
