/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/brake.h"

#include <math.h>

// From one level to another, up or down.
static double changing_loss_m_s(const cp_brake *brake, double elapsed_s)
{
    double change_m_s2 = brake->deceleration_m_s2 - brake->from_m_s2;
    double rise_s = fabs(change_m_s2) / brake->jerk_m_s3;
    double rising_s = fmin(elapsed_s, rise_s), jerk_m_s3 = copysign(brake->jerk_m_s3, change_m_s2);
    return brake->from_m_s2 * rising_s + 0.5 * jerk_m_s3 * rising_s * rising_s +
           brake->deceleration_m_s2 * (elapsed_s - rising_s);
}

double cp_brake_speed_loss_m_s(const cp_brake *brake, double time_s)
{
    double elapsed_s = time_s - brake->start_s;
    if (elapsed_s <= 0.0)
        return 0.0;
    if (brake->from_m_s2 != 0.0)
        return changing_loss_m_s(brake, elapsed_s);
    double rise_s = brake->deceleration_m_s2 / brake->jerk_m_s3;
    if (elapsed_s < rise_s)
        return 0.5 * brake->jerk_m_s3 * elapsed_s * elapsed_s;
    return brake->deceleration_m_s2 * (elapsed_s - 0.5 * rise_s);
}

double cp_brake_deceleration_m_s2(const cp_brake *brake, double time_s)
{
    double changed_m_s2 = fmax(time_s - brake->start_s, 0.0) * brake->jerk_m_s3;
    return brake->deceleration_m_s2 >= brake->from_m_s2
               ? fmin(brake->from_m_s2 + changed_m_s2, brake->deceleration_m_s2)
               : fmax(brake->from_m_s2 - changed_m_s2, brake->deceleration_m_s2);
}

void cp_braking_begin(cp_braking *braking, const cp_brake *brake)
{
    *braking =
        (cp_braking){.is_requesting = true, .brake = *brake, .commanded_until_s = brake->start_s};
}

void cp_braking_change(cp_braking *braking, double now_s, double deceleration_m_s2)
{
    cp_brake *brake = &braking->brake;
    if (now_s > brake->start_s) {
        brake->from_m_s2 = cp_brake_deceleration_m_s2(brake, now_s);
        brake->start_s = now_s;
    }
    brake->deceleration_m_s2 = deceleration_m_s2;
}

cp_status cp_braking_command(cp_braking *braking, const cp_traffic *traffic,
                             const cp_vehicle_motion *motion, cp_actuation *actuation,
                             cp_error *error)
{
    double end_s = cp_traffic_time_s(traffic) + cp_traffic_step_length_s(traffic);
    double loss_m_s = cp_brake_speed_loss_m_s(&braking->brake, end_s) -
                      cp_brake_speed_loss_m_s(&braking->brake, braking->commanded_until_s);
    if (!(loss_m_s > 0.0))
        return CP_OK;
    braking->is_braking = true;
    braking->commanded_until_s = end_s;
    cp_status status = cp_acts_brake(actuation->acts, motion->after.vehicle, braking->brake.start_s,
                                     cp_brake_deceleration_m_s2(&braking->brake, end_s), error);
    if (status != CP_OK)
        return status;
    return cp_actuation_request(actuation, motion->after.vehicle,
                                fmax(motion->after.speed_m_s - loss_m_s, 0.0),
                                cp_brake_deceleration_m_s2(&braking->brake, end_s), error);
}
