/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite_quantity.h"

#include "core/units.h"

#include <math.h>
#include <string.h>

const char *const CP_SUITE_QUANTITY_TEXT[CP_SUITE_QUANTITY_COUNT] = {
#define TEXT(name, unit, label, what) #name,
    CP_SUITE_QUANTITIES(TEXT)
#undef TEXT
};

const char *const CP_SUITE_QUANTITY_UNIT[CP_SUITE_QUANTITY_COUNT] = {
#define UNIT(name, unit, label, what) unit,
    CP_SUITE_QUANTITIES(UNIT)
#undef UNIT
};

const char *const CP_SUITE_QUANTITY_LABEL[CP_SUITE_QUANTITY_COUNT] = {
#define LABEL(name, unit, label, what) label,
    CP_SUITE_QUANTITIES(LABEL)
#undef LABEL
};

// Crash test laboratories' double integration ends there.
static const double CRUSH_UNTIL_S = 0.3;

cp_suite_quantity cp_suite_quantity_find(const char *name)
{
    int k = 0;
    while (k < CP_SUITE_QUANTITY_COUNT && strcmp(CP_SUITE_QUANTITY_TEXT[k], name) != 0)
        k++;
    return (cp_suite_quantity)k;
}

bool cp_suite_quantity_is_timed(cp_suite_quantity quantity)
{
    return quantity == CP_SUITE_dvx_m_s || quantity == CP_SUITE_dvy_away_m_s ||
           quantity == CP_SUITE_yaw_rate_at_deg_s;
}

bool cp_suite_quantity_is_of_pair(cp_suite_quantity quantity)
{
    return quantity == CP_SUITE_momentum_ratio_1 || quantity == CP_SUITE_wall_difference_pct;
}

// A channel between its samples; NAN beyond the record.
static double channel_at(const cp_pulse *pulse, cp_pulse_channel channel, double time_s)
{
    const double *value = pulse->channel[channel];
    double place = time_s / pulse->sample_interval_s;
    size_t k = (size_t)place;
    if (k + 1 >= pulse->sample_count)
        return NAN;
    return value[k] + (place - (double)k) * (value[k + 1] - value[k]);
}

static double crush_mm(const cp_pulse *pulse)
{
    const double *vx_m_s = pulse->channel[CP_CHANNEL_VX];
    double way_m = 0.0;
    for (size_t k = 1; k < pulse->sample_count; k++) {
        if ((double)k * pulse->sample_interval_s > CRUSH_UNTIL_S)
            break;
        way_m += 0.5 * (fmax(vx_m_s[k - 1], 0.0) + fmax(vx_m_s[k], 0.0)) * pulse->sample_interval_s;
    }
    return 1e3 * way_m;
}

static double rebound_m_s(const cp_pulse *pulse)
{
    double largest_m_s = 0.0;
    for (size_t k = 0; k < pulse->sample_count; k++)
        largest_m_s = fmax(largest_m_s, -pulse->channel[CP_CHANNEL_VX][k]);
    return largest_m_s;
}

// Change of velocity until separation in the axes of the first heading; it points against the
// principal direction of force.
static cp_vec2 separation_change(const cp_severity *severity)
{
    if (isnan(severity->pdof_rad))
        return (cp_vec2){0.0, 0.0};
    return cp_vec2_scale(cp_vec2_heading(severity->pdof_rad), -severity->delta_v_m_s);
}

// Along the first car's x axis; both cars collinear.
static double restitution(const cp_crash_result *result)
{
    double approach_m_s = 0.0, loss_m_s = 0.0;
    for (int c = 0; c < result->vehicle_count; c++) {
        approach_m_s += result->pulse[c].channel[CP_CHANNEL_VX][0];
        loss_m_s -= separation_change(&result->severity[c]).x;
    }
    return loss_m_s / approach_m_s - 1.0;
}

// Until both crashes have ended, rebound included.
static double wall_difference_pct(const cp_crash_result *pair, const cp_crash_result *wall)
{
    const cp_pulse *of_pair = &pair->pulse[0], *of_wall = &wall->pulse[0];
    double end_s = fmax(pair->severity[0].end_s, wall->severity[0].end_s), largest_m_s = 0.0;
    for (size_t k = 0; k < of_pair->sample_count && k < of_wall->sample_count; k++) {
        if ((double)k * of_pair->sample_interval_s > end_s)
            break;
        largest_m_s = fmax(largest_m_s, fabs(of_pair->channel[CP_CHANNEL_VX][k] -
                                             of_wall->channel[CP_CHANNEL_VX][k]));
    }
    return 100.0 * largest_m_s / of_wall->channel[CP_CHANNEL_VX][0];
}

double cp_suite_quantity_of(const cp_suite_look *look, const cp_crash_result *result)
{
    int c = look->car;
    const cp_severity *severity = &result->severity[c];
    const cp_pulse *pulse = &result->pulse[c];
    switch (look->quantity) {
    case CP_SUITE_olc_g:
        return severity->olc.status == CP_OLC_VALUE ? severity->olc.olc_g : 0.0;
    case CP_SUITE_peak_g:
        return severity->peak_g;
    case CP_SUITE_cell_force_kn:
        return 1e-3 * severity->peak_g * CP_G0_M_S2 * look->cell_mass_kg[c];
    case CP_SUITE_crush_mm:
        return crush_mm(pulse);
    case CP_SUITE_struck_mm:
        return 1e3 * result->struck[c].depth_m;
    case CP_SUITE_t_v0_ms:
        return 1e3 * severity->t_v0_s;
    case CP_SUITE_rebound_m_s:
        return rebound_m_s(pulse);
    case CP_SUITE_dvx_m_s:
        return pulse->channel[CP_CHANNEL_VX][0] - channel_at(pulse, CP_CHANNEL_VX, look->time_s);
    case CP_SUITE_dvy_away_m_s:
        return look->side_1 *
               (pulse->channel[CP_CHANNEL_VY][0] - channel_at(pulse, CP_CHANNEL_VY, look->time_s));
    case CP_SUITE_yaw_rate_at_deg_s:
        return look->side_1 * cp_deg_from_rad(channel_at(pulse, CP_CHANNEL_YAW_RATE, look->time_s));
    case CP_SUITE_separation_dvx_m_s:
        return -separation_change(severity).x;
    case CP_SUITE_separation_dvy_m_s:
        return -look->side_1 * separation_change(severity).y;
    case CP_SUITE_separation_vx_m_s:
        return pulse->channel[CP_CHANNEL_VX][0] + separation_change(severity).x;
    case CP_SUITE_yaw_rate_deg_s:
        return look->side_1 * cp_deg_from_rad(severity->yaw_change_rad_s);
    case CP_SUITE_delta_v_m_s:
        return severity->delta_v_m_s;
    case CP_SUITE_restitution_1:
        return restitution(result);
    case CP_SUITE_momentum_ratio_1:
        return look->mass_kg[0] * result->severity[0].delta_v_m_s /
               (look->mass_kg[1] * result->severity[1].delta_v_m_s);
    case CP_SUITE_wall_difference_pct:
        return wall_difference_pct(result, look->wall);
    case CP_SUITE_QUANTITY_COUNT:
        break;
    }
    return NAN;
}
