/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_SUMO_LIST_H
#define STUDY_SUMO_LIST_H

#include "core/error.h"

/* A list of file names as SUMO takes it in an option: ${NAME} of the environment put in, split at
 * commas, blanks around a name cut off, empty names passed over. */
typedef struct cp_sumo_list {
    char *text; /* owned */
    char *rest; /* what has not been given out yet */
} cp_sumo_list;

/* The caller destroys. what: for the error. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_sumo_list_create(const char *text, const char *what, cp_sumo_list *list,
                                            cp_error *error);
void cp_sumo_list_destroy(cp_sumo_list *list);

/* The next name, the caller's to change in place; NULL at the end. */
char *cp_sumo_list_next(cp_sumo_list *list);

/* %20 and the like in place, as SUMO takes them in names of a .sumocfg. */
void cp_sumo_name_decode(char *name);

#endif
