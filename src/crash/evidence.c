/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/evidence.h"

#include "core/units.h"
#include "crash/validity_reason.h"

#include <math.h>
#include <string.h>

// Limits are met by configurations given as round numbers of km/h, mm and degrees.
static const double ROUNDING = 1e-9;

static bool is_of(const cp_evidence *row, const cp_vehicle_model *model)
{
    return strcmp(row->vehicle, model->name) == 0 && strcmp(row->vehicle_hash, model->hash) == 0;
}

bool cp_evidence_judges(const cp_vehicle_model *model)
{
    for (size_t k = 0; k < cp_evidence_count(); k++)
        if (is_of(cp_evidence_at(k), model))
            return true;
    return false;
}

static const char *opponent_of(const cp_crash_configuration *configuration, int role)
{
    if (configuration->against_barrier)
        return "front";
    switch (configuration->side[1 - role]) {
    case CP_SIDE_FRONT:
        return "front";
    case CP_SIDE_REAR:
        return "rear";
    default:
        return "side";
    }
}

cp_evidence_case cp_evidence_case_of(const cp_vehicle_model *model_a,
                                     const cp_vehicle_model *model_b,
                                     const cp_crash_configuration *configuration,
                                     const cp_crash_description *description, int role)
{
    const cp_vehicle_model *own = role == 0 ? model_a : model_b;
    const cp_vehicle_model *other = role == 0 ? model_b : model_a;
    double share =
        configuration->against_barrier ? 1.0 : other->mass_kg / (own->mass_kg + other->mass_kg);
    // What is covered of a is covered of b, but for the width it is a share of.
    double overlap_1 = description->overlap_1;
    if (role == 1)
        overlap_1 = fmin(1.0, overlap_1 * model_a->width_m / model_b->width_m);
    return (cp_evidence_case){
        .opponent = opponent_of(configuration, role),
        .speed_km_h = cp_km_h_from_m_s(description->closing_speed_m_s * share),
        .overlap_1 = isnan(description->overlap_1) ? NAN : overlap_1,
        .angle_deg = cp_deg_from_rad(description->angle_rad),
        .velocity_angle_deg = cp_deg_from_rad(description->velocity_angle_rad[role])};
}

// By what the case misses the class, its opponent aside.
static unsigned misses(const cp_evidence *row, const cp_evidence_case *crash)
{
    unsigned outside = 0;
    if (crash->speed_km_h < row->speed_min_km_h - ROUNDING ||
        crash->speed_km_h > row->speed_max_km_h + ROUNDING)
        outside |= CP_OUTSIDE_SPEED;
    if (crash->overlap_1 < row->overlap_min_1 - ROUNDING ||
        crash->overlap_1 > row->overlap_max_1 + ROUNDING)
        outside |= CP_OUTSIDE_OFFSET;
    if (fabs(crash->angle_deg) > row->angle_max_deg + ROUNDING)
        outside |= CP_OUTSIDE_ANGLE;
    if (fabs(crash->velocity_angle_deg) > row->velocity_angle_max_deg + ROUNDING)
        outside |= CP_OUTSIDE_OBLIQUE_VELOCITY;
    return outside;
}

static int count_of(unsigned reasons)
{
    int count = 0;
    for (; reasons != 0; reasons &= reasons - 1)
        count++;
    return count;
}

const cp_evidence *cp_evidence_find(const cp_vehicle_model *model, const cp_evidence_case *crash,
                                    unsigned *outside)
{
    bool any_kept = false, has_opponent = false;
    unsigned fewest =
        CP_OUTSIDE_SPEED | CP_OUTSIDE_OFFSET | CP_OUTSIDE_ANGLE | CP_OUTSIDE_OBLIQUE_VELOCITY;
    *outside = 0;
    for (size_t k = 0; k < cp_evidence_count(); k++) {
        const cp_evidence *row = cp_evidence_at(k);
        if (!row->kept || !is_of(row, model))
            continue;
        bool same_opponent = strcmp(row->opponent, crash->opponent) == 0;
        unsigned missed = misses(row, crash);
        if (same_opponent && missed == 0)
            return row;
        // Nearest among those of the opponent, else among all.
        if (!any_kept || (same_opponent && !has_opponent) ||
            (same_opponent == has_opponent && count_of(missed) < count_of(fewest)))
            fewest = missed;
        any_kept = true;
        has_opponent = has_opponent || same_opponent;
    }
    *outside =
        any_kept ? fewest | (has_opponent ? 0u : CP_OUTSIDE_OPPONENT_STRUCTURE) : CP_OUTSIDE_MODEL;
    return NULL;
}
