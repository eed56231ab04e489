/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_INVENTED_STUDY_H
#define BUILDERS_INVENTED_STUDY_H

#include "analysis/comparison.h"

#include <math.h>
#include <stdlib.h>

/* Small studies made row by row, of one baseline and one treatment with paired seeds. Include after
 * cmocka.h. */

enum { INVENTED_MOST = 4000 };

typedef struct invented_study {
    cp_study_data data;
    cp_study_scenario scenario[32];
    cp_study_variant variant[2];
    cp_study_replication replication[256];
    cp_study_crash crash[INVENTED_MOST];
    cp_study_vehicle vehicle[2 * INVENTED_MOST];
    cp_study_pair pair[INVENTED_MOST];
    cp_study_risk risk;
    char *crash_type[1];
    char *validity[2];
} invented_study;

/* replications of every scenario and variant, 100 vehicle-km each, in the order of a study read
 * from a database: by scenario, number, variant. The caller frees with invented_destroy. */
static inline invented_study *invented(size_t scenarios, size_t replications)
{
    static char front_front[] = "front-front", inside[] = "inside", outside[] = "speed";
    static char baseline[] = "baseline", aeb[] = "aeb", name[] = "invented", level[] = "MAIS2+";
    static char empty[] = "";
    invented_study *s = calloc(1, sizeof *s);
    assert_non_null(s);
    for (size_t k = 0; k < scenarios; k++)
        s->scenario[k] = (cp_study_scenario){name, json_array()};
    s->variant[0] = (cp_study_variant){baseline, true, NULL};
    s->variant[1] = (cp_study_variant){aeb, false, NULL};
    s->crash_type[0] = front_front;
    s->validity[0] = inside;
    s->validity[1] = outside;
    s->risk = (cp_study_risk){.name = name,
                              .level = level,
                              .source = empty,
                              .note = empty,
                              .predictor = CP_PREDICTOR_DELTA_V};
    s->risk.function = (cp_risk_function){
        .form = CP_RISK_LOGISTIC, .coefficient = {-5.0, 0.3}, .unit_per_si = 1.0};
    s->data = (cp_study_data){
        .name = name,
        .paired = true,
        .seed = 1,
        .scenario_count = scenarios,
        .scenario = s->scenario,
        .variant_count = 2,
        .variant = s->variant,
        .replication = s->replication,
        .crash_type_count = 1,
        .crash_type = s->crash_type,
        .crash = s->crash,
        .vehicle = s->vehicle,
        .pair = s->pair,
        .risk_count = 1,
        .risk = &s->risk,
        .validity_count = 2,
        .validity = s->validity,
    };
    for (size_t k = 0; k < scenarios; k++)
        for (size_t n = 0; n < replications; n++)
            for (size_t v = 0; v < 2; v++)
                s->replication[s->data.replication_count++] =
                    (cp_study_replication){k, v, (int64_t)n, 70 + (int64_t)n, 100.0, 2.0};
    return s;
}

static inline void invented_destroy(invented_study *s)
{
    for (size_t k = 0; k < s->data.scenario_count; k++)
        json_decref(s->scenario[k].driver_errors);
    free(s);
}

/* A frontal crash of a replication: role a is struck on its front, b is not. olc_g: -INFINITY for
 * left-censored. delta-v goes with it. */
static inline void invented_crash(invented_study *s, size_t replication, double olc_g, bool inside)
{
    assert_true(s->data.crash_count < INVENTED_MOST);
    size_t crash = s->data.crash_count++;
    bool censored = isinf(olc_g);
    s->crash[crash] = (cp_study_crash){
        .id = (int64_t)crash, .replication = replication, .frontal = true, .inside = inside};
    for (size_t role = 0; role < 2; role++) {
        cp_study_vehicle *v = &s->vehicle[s->data.vehicle_count++];
        *v = (cp_study_vehicle){.crash = crash,
                                .role = role ? 'b' : 'a',
                                .frontal = role == 0,
                                .olc = censored ? CP_OLC_CENSORED : CP_OLC_KNOWN,
                                .olc_g = censored ? NAN : olc_g,
                                .delta_v_m_s = censored ? 1.0 : 0.7 * olc_g,
                                .closing_speed_m_s = censored ? 2.0 : 1.2 * olc_g,
                                .validity = !inside};
        for (int k = 0; k < CP_PREDICTOR_COUNT; k++)
            v->predictor[k] = v->delta_v_m_s;
        s->data.frontal_vehicle_count += role == 0;
    }
}

/* Of a scenario's replication number in a variant; replications of each scenario as created. */
static inline size_t invented_replication(size_t replications, size_t scenario, size_t number,
                                          size_t variant)
{
    return 2 * (scenario * replications + number) + variant;
}

#endif
