/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/brake.h"

double cp_brake_speed_loss_m_s(const cp_brake *brake, double time_s)
{
    double elapsed_s = time_s - brake->start_s;
    if (elapsed_s <= 0.0)
        return 0.0;
    double rise_s = brake->deceleration_m_s2 / brake->jerk_m_s3;
    if (elapsed_s < rise_s)
        return 0.5 * brake->jerk_m_s3 * elapsed_s * elapsed_s;
    return brake->deceleration_m_s2 * (elapsed_s - 0.5 * rise_s);
}
