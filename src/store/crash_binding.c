/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/crash_binding.h"

#include "store/participant_binding.h"

#include <math.h>

static void bind_vehicle_state(cp_statement *s, const cp_crash_vehicle_row *vehicle)
{
    cp_bind_integer(s, 5, vehicle->side == CP_SIDE_FRONT);
    cp_bind_text(s, 6, vehicle->sumo_id);
    cp_bind_text(s, 7, vehicle->sumo_type);
    cp_bind_text(s, 8, vehicle->vehicle_model);
    cp_bind_integer(s, 9, vehicle->at_fault);
    cp_bind_real(s, 10, vehicle->body.cog_m.x);
    cp_bind_real(s, 11, vehicle->body.cog_m.y);
    cp_bind_real(s, 12, vehicle->body.yaw_rad);
    cp_bind_real(s, 13, vehicle->body.velocity_m_s.x);
    cp_bind_real(s, 14, vehicle->body.velocity_m_s.y);
    cp_bind_real(s, 15, vehicle->body.yaw_rate_rad_s);
    cp_bind_real(s, 16, vehicle->speed_m_s);
    cp_bind_real(s, 17, vehicle->length_m);
    cp_bind_real(s, 18, vehicle->width_m);
    cp_bind_real(s, 19, vehicle->velocity_angle_rad);
    cp_bind_text(s, 20, cp_contact_side_text(vehicle->side));
}

static void bind_severity(cp_statement *s, const cp_crash_vehicle_row *vehicle)
{
    const cp_severity *severity = &vehicle->severity;
    bool value = severity->olc.status == CP_OLC_VALUE;
    cp_bind_real(s, 22, value ? severity->olc.olc_g : NAN);
    cp_bind_text(s, 23, cp_olc_status_text(severity->olc.status));
    cp_bind_real(s, 24, value ? severity->olc.t1_s : NAN);
    cp_bind_real(s, 25, value ? severity->olc.t2_s : NAN);
    cp_bind_real(s, 26, severity->delta_v_m_s);
    cp_bind_real(s, 27, severity->delta_v_x_m_s);
    cp_bind_real(s, 28, severity->delta_v_y_m_s);
    cp_bind_real(s, 29, severity->peak_g);
    cp_bind_real(s, 30, severity->mean_g);
    cp_bind_real(s, 31, severity->t_v0_s);
    cp_bind_real(s, 32, severity->max_50ms_g);
    cp_bind_real(s, 33, severity->asi_1);
    cp_bind_real(s, 34, severity->pdof_rad);
    cp_bind_real(s, 35, severity->yaw_change_rad_s);
    cp_bind_real(s, 36, vehicle->crush_m);
    cp_bind_real(s, 37, severity->end_s);
    cp_bind_real(s, 38, vehicle->absorbed_j);
    cp_bind_real(s, 39, vehicle->ees_m_s);
    cp_bind_real(s, 40, vehicle->olc_sd_g);
}

// Who and where: parameters 41 to 45.
static void bind_place(cp_statement *s, const cp_crash_row *crash, int role)
{
    const cp_crash_vehicle_row *vehicle = &crash->vehicle[role];
    int errors = cp_participant_error_count(&crash->participants, role);
    cp_bind_real(s, 41, vehicle->mass_kg);
    cp_bind_text(s, 42, vehicle->lane);
    cp_bind_text(s, 43, vehicle->edge);
    cp_bind_text(s, 44, vehicle->junction);
    if (errors < 0)
        cp_bind_text(s, 45, NULL);
    else
        cp_bind_integer(s, 45, errors);
}

// How far it was pushed in: parameters 46 to 48.
static void bind_intrusion(cp_statement *s, const cp_crash_vehicle_row *vehicle)
{
    cp_bind_real(s, 46, vehicle->intrusion_m);
    cp_bind_text(s, 47, vehicle->intrusion_zone);
    cp_bind_real(s, 48, vehicle->severity.max_50ms_y_g);
}

// What was drawn of the car, and what speaks for its severity: parameters 49 to 52.
static void bind_car(cp_statement *s, const cp_crash_vehicle_row *vehicle)
{
    const cp_olc *olc = &vehicle->severity.olc;
    bool is_drawn = vehicle->drawn != NULL && vehicle->drawn[0] != '\0';
    bool has_class = vehicle->evidence_class != NULL;
    double error_1 = has_class ? vehicle->class_error_1 : NAN;
    double olc_g = NAN;
    if (olc->status == CP_OLC_VALUE)
        olc_g = olc->olc_g;
    else if (olc->status == CP_OLC_NO_DECELERATION || olc->status == CP_OLC_BEYOND_HORIZON)
        olc_g = 0.0;
    cp_bind_text(s, 49, is_drawn ? vehicle->drawn : NULL);
    cp_bind_text(s, 50, vehicle->evidence_class);
    cp_bind_real(s, 51, error_1);
    cp_bind_real(s, 52, error_1 * olc_g);
}

void cp_bind_crash_vehicle(cp_statement *s, const cp_crash_row *crash, int role,
                           char validity[CP_VALIDITY_TEXT_SIZE])
{
    const cp_crash_vehicle_row *vehicle = &crash->vehicle[role];
    bind_vehicle_state(s, vehicle);
    cp_bind_text(s, 21, cp_validity_text(vehicle->outside, validity));
    bind_severity(s, vehicle);
    bind_place(s, crash, role);
    bind_intrusion(s, vehicle);
    bind_car(s, vehicle);
}

// OLC by every parameter set, parameters 1 to key being bound already.
cp_status cp_write_members(cp_statement *s, int key, const cp_crash_vehicle_row *vehicle,
                           cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t m = 0; status == CP_OK && m < vehicle->member_count; m++) {
        const cp_olc *olc = &vehicle->member[m];
        cp_bind_integer(s, key + 1, (int64_t)m);
        cp_bind_real(s, key + 2, olc->status == CP_OLC_VALUE ? olc->olc_g : NAN);
        cp_bind_text(s, key + 3, cp_olc_status_text(olc->status));
        status = cp_statement_run(s, error);
    }
    return status;
}
