/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_STUDY_FIXTURE_H
#define TESTS_STUDY_FIXTURE_H

#include "core/file.h"
#include "study/plan.h"
#include "study/study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A folder with a complete study in it, for tests to bend. */

static const char GOOD_STUDY[] = "study: demo\n"                               // 1
                                 "question: Does it help?\n"                   // 2
                                 "design: paired_seeds\n"                      // 3
                                 "seed: 20261122\n"                            // 4
                                 "replications: 3\n"                           // 5
                                 "duration_s: 900\n"                           // 6
                                 "warmup_s: 60\n"                              // 7
                                 "scenarios:\n"                                // 8
                                 "  - name: left_turn\n"                       // 9
                                 "    sumocfg: a.sumocfg\n"                    // 10
                                 "    sumo_options: [--scale, \"0.5\"]\n"      // 11
                                 "    driver_errors:\n"                        // 12
                                 "      - model: failed_to_see\n"              // 13
                                 "        parameters: {probability_1: 0.25}\n" // 14
                                 "variants:\n"                                 // 15
                                 "  - name: baseline\n"                        // 16
                                 "    functions: []\n"                         // 17
                                 "  - name: aeb\n"                             // 18
                                 "    functions:\n"                            // 19
                                 "      - function: aeb\n"                     // 20
                                 "        parameters:\n"                       // 21
                                 "          ttc_s: 1.5\n"                      // 22
                                 "          deceleration_m_s2: 7\n"            // 23
                                 "vehicles:\n"                                 // 24
                                 "  default: car.yaml\n"                       // 25
                                 "  types:\n"                                  // 26
                                 "    - type: van\n"                           // 27
                                 "      model: van.yaml\n";                    // 28

typedef struct fixture {
    char folder[64];
    char study[96];
} fixture;

static inline void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s: %s", cp_status_text(status), error->text);
}

static inline void write_text(const fixture *f, const char *name, const char *text)
{
    char path[192];
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    assert_ok(cp_file_write(path, text, strlen(text), &error), &error);
}

static inline int fixture_begin(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    snprintf(f->folder, sizeof f->folder, "/tmp/crashpulse-test-XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->study, sizeof f->study, "%s/study.yaml", f->folder);
    write_text(f, "study.yaml", GOOD_STUDY);
    write_text(f, "a.sumocfg",
               "<configuration><!-- of Monday --><input>\n"
               "<net-file value=\"a.net.xml\"/>\n"
               "<route-files value='a.rou.xml, b.rou.xml,missing.rou.xml'/>\n"
               "</input><output><tripinfo-output value=\"trip.xml\"/></output>"
               "</configuration>\n");
    write_text(f, "a.net.xml", "<!-- generated on Monday --><net/>\n");
    write_text(f, "a.rou.xml", "<routes/>\n");
    write_text(f, "b.rou.xml", "<routes><vType id=\"van\"/></routes>\n");
    write_text(f, "trip.xml", "<trips/>\n");
    write_text(f, "car.yaml", "name: car\n");
    write_text(f, "van.yaml", "name: van\n");
    *state = f;
    return 0;
}

static inline int fixture_end(void **state)
{
    fixture *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", f->folder);
    int failed = system(command);
    free(f);
    return failed;
}

/* The good study with the first occurrence of old replaced; the caller frees. */
static inline char *study_with(const char *old, const char *replacement)
{
    const char *place = strstr(GOOD_STUDY, old);
    assert_non_null(place);
    char *text = malloc(sizeof GOOD_STUDY + strlen(replacement));
    assert_non_null(text);
    sprintf(text, "%.*s%s%s", (int)(place - GOOD_STUDY), GOOD_STUDY, replacement,
            place + strlen(old));
    return text;
}

#endif
