/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/candidate.h"

#include <math.h>
#include <string.h>

// Field of the barrier by the name of an unknown; NULL for a vehicle parameter.
static double *barrier_field(cp_barrier *barrier, const char *name)
{
    if (strcmp(name, "barrier.width_m") == 0)
        return &barrier->width_m;
    if (strcmp(name, "barrier.depth_m") == 0)
        return &barrier->depth_m;
    if (strcmp(name, "barrier.corner_radius_m") == 0)
        return &barrier->corner_radius_m;
    if (strcmp(name, "barrier.pivot_m") == 0)
        return &barrier->pivot_m;
    return NULL;
}

bool cp_unknown_exists(const char *name)
{
    cp_barrier barrier = cp_barrier_default();
    return barrier_field(&barrier, name) != NULL ||
           cp_vehicle_parameter_index(name) < CP_VEHICLE_PARAMETER_COUNT;
}

double cp_unknown_get(const cp_vehicle_model *model, const char *name)
{
    cp_barrier barrier = model->barrier;
    const double *field = barrier_field(&barrier, name);
    return field != NULL ? *field : cp_vehicle_model_get(model, cp_vehicle_parameter_index(name));
}

void cp_unknown_set(cp_vehicle_model *model, const char *name, double value)
{
    double *field = barrier_field(&model->barrier, name);
    if (field != NULL)
        *field = value;
    else
        cp_vehicle_model_set(model, cp_vehicle_parameter_index(name), value);
}

// Lengths that depend on another length.
static void fit_lengths(cp_vehicle_model *m)
{
    const double smallest_engine_m = 0.15;
    m->crash_box_collapse_end_m = fmin(m->crash_box_collapse_end_m, m->crash_box_length_m);
    m->longitudinal_collapse_end_m = fmin(m->longitudinal_collapse_end_m, m->longitudinal_length_m);
    double corner_length_m = m->cross_member_depth_m + m->crash_box_length_m +
                             m->longitudinal_length_m - m->corner_gap_m;
    m->corner_collapse_end_m = fmin(m->corner_collapse_end_m, corner_length_m);
    double upper_length_m = corner_length_m + m->corner_gap_m - m->upper_gap_m;
    m->upper_collapse_end_m = fmin(m->upper_collapse_end_m, upper_length_m);
    double bay_m = m->crash_box_length_m + m->longitudinal_length_m - m->engine_gap_firewall_m;
    m->engine_gap_front_m = fmin(m->engine_gap_front_m, bay_m - smallest_engine_m);
    m->cross_member_half_width_m = fmin(m->cross_member_half_width_m, 0.5 * m->width_m);
    // A crash box gives way before the longitudinal behind it, and the bumper before the box.
    double rail_kn = m->longitudinal_collapse_begin_kn;
    m->crash_box_collapse_begin_kn = fmin(m->crash_box_collapse_begin_kn, rail_kn);
    m->crash_box_collapse_end_kn = fmin(m->crash_box_collapse_end_kn, rail_kn);
    m->bumper_kn = fmin(m->bumper_kn, m->crash_box_collapse_begin_kn);

    // Steeper unloading than the time step stands is cut to what it does.
    m->unload_end_factor_1 = fmax(m->unload_end_factor_1, m->unload_factor_1);
    double largest_s = cp_vehicle_model_largest_step(m, NULL);
    if (largest_s < 0.0005) {
        double share = 0.999 * (largest_s / 0.0005) * (largest_s / 0.0005);
        m->unload_end_factor_1 = fmax(1.0, share * m->unload_end_factor_1);
        m->unload_factor_1 = fmin(m->unload_factor_1, m->unload_end_factor_1);
    }
    cp_barrier *barrier = &m->barrier;
    barrier->corner_radius_m =
        fmin(barrier->corner_radius_m, 0.5 * fmin(barrier->width_m, barrier->depth_m));
}

cp_vehicle_model cp_candidate_model(const cp_vehicle_model *base, const cp_unknown *unknowns,
                                    size_t count, const double *point)
{
    cp_vehicle_model model = *base;
    for (size_t k = 0; k < count; k++)
        cp_unknown_set(&model, unknowns[k].name,
                       unknowns[k].min + point[k] * (unknowns[k].max - unknowns[k].min));
    fit_lengths(&model);
    return model;
}

void cp_candidate_point(const cp_vehicle_model *base, const cp_unknown *unknowns, size_t count,
                        double *point)
{
    for (size_t k = 0; k < count; k++) {
        double value = cp_unknown_get(base, unknowns[k].name);
        double share = (value - unknowns[k].min) / (unknowns[k].max - unknowns[k].min);
        point[k] = fmin(1.0, fmax(0.0, share));
    }
}
