/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/validity.h"

#include "core/units.h"
#include "crash/evidence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Range limits are met by configurations given as round numbers of km/h, mm and degrees.
static const double ROUNDING = 1e-9;

// Beyond this the impact counts as oblique. The reference cases are all at 0: an assumption.
static const double OBLIQUE_LIMIT_DEG = 15.0;

// Of a model that the scorecard does not judge: its own calibrated range.
static unsigned outside_own_range(const cp_vehicle_model *model_a, const cp_vehicle_model *own,
                                  const cp_crash_configuration *configuration,
                                  const cp_crash_description *description,
                                  const cp_evidence_case *crash, int role)
{
    unsigned outside = 0;
    // A model without a calibrated range has no other limits to be within.
    bool calibrated = own->calibrated_speed_max_m_s > 0.0;
    double equivalent_m_s = cp_m_s_from_km_h(crash->speed_km_h);
    if (calibrated && (equivalent_m_s < own->calibrated_speed_min_m_s - ROUNDING ||
                       equivalent_m_s > own->calibrated_speed_max_m_s + ROUNDING))
        outside |= CP_OUTSIDE_SPEED;

    // Offset as this vehicle sees it: of the middle of the other's front edge in its own frame.
    double offset_m = description->lateral_offset_m;
    if (role == 1) {
        const cp_body_state *a = &configuration->vehicle[0], *b = &configuration->vehicle[1];
        cp_pose frame = {b->cog_m, b->yaw_rad};
        cp_vec2 front_m = cp_vec2_add(
            a->cog_m, cp_vec2_scale(cp_vec2_heading(a->yaw_rad), model_a->cg_to_front_m));
        offset_m = cp_pose_to_local(frame, front_m).y;
    }
    if (calibrated && fabs(offset_m) > own->calibrated_offset_max_m + ROUNDING)
        outside |= CP_OUTSIDE_OFFSET;
    if (calibrated && fabs(description->angle_rad) > own->calibrated_angle_max_rad + ROUNDING)
        outside |= CP_OUTSIDE_ANGLE;
    if (!calibrated)
        outside |= CP_OUTSIDE_MODEL;
    if (fabs(description->velocity_angle_rad[role]) > cp_rad_from_deg(OBLIQUE_LIMIT_DEG) + ROUNDING)
        outside |= CP_OUTSIDE_OBLIQUE_VELOCITY;
    return strcmp(crash->opponent, "front") == 0 ? outside
                                                 : outside | CP_OUTSIDE_OPPONENT_STRUCTURE;
}

unsigned cp_validity(const cp_vehicle_model *model_a, const cp_vehicle_model *model_b,
                     const cp_crash_configuration *configuration,
                     const cp_crash_description *description, int role, cp_validity_ground *ground)
{
    const cp_vehicle_model *own = role == 0 ? model_a : model_b;
    const cp_vehicle_model *other = role == 0 ? model_b : model_a;
    cp_evidence_case crash =
        cp_evidence_case_of(model_a, model_b, configuration, description, role);
    cp_validity_ground found = {.evidence_class = CP_EVIDENCE_OWN, .error_1 = NAN};
    unsigned outside = 0;
    if (cp_evidence_judges(own)) {
        const cp_evidence *evidence = cp_evidence_find(own, &crash, &outside);
        if (evidence != NULL)
            found = (cp_validity_ground){evidence->name, evidence->error_1};
    } else {
        outside = outside_own_range(model_a, own, configuration, description, &crash, role);
    }

    // What no class and no range allows for.
    if (own->is_stretched)
        outside |= CP_OUTSIDE_SIZE;
    if (configuration->side[role] != CP_SIDE_FRONT)
        outside |= CP_OUTSIDE_CONTACT_SIDE;
    if (!configuration->against_barrier && other->mass_kg > CP_HEAVY_FROM_KG)
        outside |= CP_OUTSIDE_OPPONENT_STRUCTURE;
    if (ground != NULL)
        *ground = outside == 0 ? found : (cp_validity_ground){NULL, NAN};
    return outside;
}

unsigned cp_validity_of_meeting(bool touched, double shift_m)
{
    if (!touched)
        return CP_OUTSIDE_NO_CONTACT;
    return fabs(shift_m) > CP_MOVED_LARGEST_M ? CP_OUTSIDE_MOVED : 0;
}

const char *cp_validity_text(unsigned outside, char text[CP_VALIDITY_TEXT_SIZE])
{
    static const struct {
        unsigned reason;
        const char *name;
    } REASONS[] = {
#define CP_VALIDITY_ROW(name, bit, words) {name, words},
        CP_VALIDITY_REASONS(CP_VALIDITY_ROW)
#undef CP_VALIDITY_ROW
    };
    if (outside == 0)
        return strcpy(text, "inside");
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < sizeof REASONS / sizeof REASONS[0]; k++)
        if ((outside & REASONS[k].reason) != 0)
            used += (size_t)snprintf(text + used, CP_VALIDITY_TEXT_SIZE - used, "%s%s",
                                     used > 0 ? "," : "", REASONS[k].name);
    return text;
}
