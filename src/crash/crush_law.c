/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crush_law.h"

#include <math.h>

// Shares of cell_kn that one part rests on.
static const double CELL_SHARE_FOOT_1 = 0.2, CELL_SHARE_FIREWALL_1 = 0.2, CELL_SHARE_UPPER_1 = 0.1;

// Force at which a member or a box is drawn out, of the largest force of its collapse.
static const double PULL_1 = 0.5;

static void add_point(cp_crush_law *law, double s_m, double force_kn)
{
    law->s_m[law->points] = s_m;
    law->force_n[law->points] = 1e3 * force_kn;
    law->points++;
}

// Stop, plateau and unloading of a law whose points stand.
static void finish(cp_crush_law *law, const cp_vehicle_model *m, double stop_kn_m,
                   double plateau_kn)
{
    law->stop_n_m = 1e3 * stop_kn_m;
    law->plateau_n = fmax(1e3 * plateau_kn, cp_crush_collapse_force(law));

    // It unloads by a multiple of its own steepest rise, never more softly than its stop.
    double steepest_n_m = law->force_n[0] / law->s_m[0];
    for (int k = 1; k < law->points; k++)
        steepest_n_m = fmax(steepest_n_m, (law->force_n[k] - law->force_n[k - 1]) /
                                              (law->s_m[k] - law->s_m[k - 1]));
    law->unload_n_m = fmax(m->unload_factor_1 * steepest_n_m, steepest_n_m);
    double end_factor_1 = fmax(m->unload_factor_1, m->unload_end_factor_1);
    law->unload_end_n_m = fmax(end_factor_1 * steepest_n_m, law->stop_n_m);
    law->unload_n_m = fmin(law->unload_n_m, law->unload_end_n_m);
}

cp_crush_law cp_crush_law_share(cp_crush_law law, double share_1)
{
    for (int k = 0; k < law.points; k++)
        law.force_n[k] *= share_1;
    law.stop_n_m *= share_1;
    law.plateau_n *= share_1;
    law.unload_n_m *= share_1;
    law.unload_end_n_m *= share_1;
    law.pull_n *= share_1;
    return law;
}

cp_crush_law cp_longitudinal_law(const cp_vehicle_model *m)
{
    cp_crush_law law = {0};
    double begin_m = m->longitudinal_collapse_begin_m, end_m = m->longitudinal_collapse_end_m;
    add_point(&law, begin_m, m->longitudinal_collapse_begin_kn);
    add_point(&law, 0.5 * (begin_m + end_m), m->longitudinal_collapse_middle_kn);
    add_point(&law, end_m, m->longitudinal_collapse_end_kn);
    finish(&law, m, m->stop_stiffness_kn_m, CELL_SHARE_FOOT_1 * m->cell_kn);
    law.pull_n = PULL_1 * cp_crush_collapse_force(&law);
    return law;
}

cp_crush_law cp_crash_box_law(const cp_vehicle_model *m)
{
    cp_crush_law law = {0};
    double stroke_m = m->bumper_stroke_m;
    if (stroke_m > 0.0) {
        add_point(&law, stroke_m / 3.0, m->bumper_kn);
        add_point(&law, stroke_m, m->bumper_kn);
    }
    add_point(&law, stroke_m + m->crash_box_collapse_begin_m, m->crash_box_collapse_begin_kn);
    add_point(&law, stroke_m + m->crash_box_collapse_end_m, m->crash_box_collapse_end_kn);

    // Behind it stands the longitudinal, which yields by its own law.
    finish(&law, m, m->stop_stiffness_kn_m, INFINITY);
    law.pull_n = PULL_1 * cp_crush_collapse_force(&law);
    return law;
}

cp_crush_law cp_engine_bay_law(const cp_vehicle_model *m)
{
    cp_crush_law law = {0};
    double gap_m = m->engine_gap_firewall_m;
    add_point(&law, fmin(0.02, 0.5 * gap_m), 0.5 * m->engine_cradle_kn);
    add_point(&law, gap_m, 0.5 * m->engine_cradle_kn);
    finish(&law, m, 0.5 * m->firewall_stiffness_kn_m, CELL_SHARE_FIREWALL_1 * m->cell_kn);

    // The firewall springs back as a sheet, not as the cradle does.
    law.unload_n_m = fmax(law.unload_n_m, m->unload_factor_1 * law.stop_n_m);
    law.unload_end_n_m = fmax(law.unload_n_m, m->unload_end_factor_1 * law.stop_n_m);
    return law;
}

cp_crush_law cp_corner_law(const cp_vehicle_model *m)
{
    cp_crush_law law = {0};
    add_point(&law, m->corner_collapse_begin_m, m->corner_collapse_begin_kn);
    add_point(&law, m->corner_collapse_end_m, m->corner_collapse_end_kn);
    finish(&law, m, m->body_stiffness_kn_m, m->cell_edge_kn);
    return law;
}

cp_crush_law cp_upper_law(const cp_vehicle_model *m)
{
    cp_crush_law law = {0};
    add_point(&law, m->upper_collapse_begin_m, m->upper_collapse_begin_kn);
    add_point(&law, m->upper_collapse_end_m, m->upper_collapse_end_kn);
    finish(&law, m, m->body_stiffness_kn_m, CELL_SHARE_UPPER_1 * m->cell_kn);
    return law;
}

cp_crush_law cp_cell_edge_law(const cp_vehicle_model *m)
{
    // Its elastic rise is that of the contact.
    cp_crush_law law = {0};
    add_point(&law, 1e-4, m->cell_edge_kn);
    finish(&law, m, 0.0, m->cell_edge_kn);
    return law;
}

cp_crush_law cp_corner_side_law(const cp_vehicle_model *m)
{
    cp_crush_law law = {0};
    add_point(&law, fmin(0.02, 0.5 * m->corner_side_m), m->corner_side_kn);
    add_point(&law, m->corner_side_m, m->corner_side_kn);
    finish(&law, m, m->body_stiffness_kn_m, INFINITY);
    return law;
}

cp_crush_law cp_side_zone_law(const cp_vehicle_model *m, int zone)
{
    const double begin_kn[CP_SIDE_ZONES] = {m->side_front_wheel_begin_kn_m, m->side_door_begin_kn_m,
                                            m->side_rear_wheel_begin_kn_m};
    const double end_kn[CP_SIDE_ZONES] = {m->side_front_wheel_end_kn_m, m->side_door_end_kn_m,
                                          m->side_rear_wheel_end_kn_m};
    cp_crush_law law = {0};
    add_point(&law, m->side_collapse_begin_m, begin_kn[zone]);
    add_point(&law, m->side_collapse_end_m, end_kn[zone]);
    finish(&law, m, m->body_stiffness_kn_m, m->cell_kn);
    return law;
}

cp_crush_law cp_side_law(const cp_crush_law zone[CP_SIDE_ZONES],
                         const double width_m[CP_SIDE_ZONES])
{
    cp_crush_law law = zone[0];
    for (int k = 0; k < law.points; k++) {
        law.force_n[k] = 0.0;
        for (int z = 0; z < CP_SIDE_ZONES; z++)
            law.force_n[k] += width_m[z] * zone[z].force_n[k];
    }
    law.plateau_n = fmax(law.plateau_n, cp_crush_collapse_force(&law));
    return law;
}

cp_crush_law cp_rear_law(const cp_vehicle_model *m)
{
    static const double RISE_M = 0.03; // from the bumper's force to that of rails and floor
    cp_crush_law law = {0};
    add_point(&law, m->rear_bumper_m / 3.0, m->rear_bumper_kn);
    add_point(&law, m->rear_bumper_m, m->rear_bumper_kn);
    add_point(&law, m->rear_bumper_m + RISE_M, m->rear_collapse_begin_kn);
    add_point(&law, m->rear_collapse_end_m, m->rear_collapse_end_kn);
    finish(&law, m, m->body_stiffness_kn_m, m->cell_kn);
    return law;
}

cp_crush_law cp_rear_side_law(const cp_vehicle_model *m)
{
    cp_crush_law law = {0};
    add_point(&law, fmin(0.02, 0.5 * m->rear_side_m), m->rear_side_kn);
    add_point(&law, m->rear_side_m, m->rear_side_kn);
    finish(&law, m, m->body_stiffness_kn_m, INFINITY);
    return law;
}

cp_crush_law cp_barrier_face_law(const cp_barrier *barrier)
{
    // Honeycomb: constant forces after a short rise each, then the rigid body behind it.
    static const double RISE_M = 0.01, STEP_M = 0.02, STOP_N_M = 2e7, UNLOAD_1 = 2.0;
    cp_crush_law law = {.stop_n_m = STOP_N_M, .plateau_n = INFINITY};
    if (barrier->face_bumper_m > 0.0) {
        add_point(&law, RISE_M, barrier->face_bumper_kn);
        add_point(&law, barrier->face_bumper_m + RISE_M, barrier->face_bumper_kn);
        add_point(&law, barrier->face_bumper_m + RISE_M + STEP_M, barrier->face_kn);
    } else {
        add_point(&law, RISE_M, barrier->face_kn);
    }
    add_point(&law, barrier->face_m, barrier->face_kn);
    law.unload_n_m = law.unload_end_n_m = UNLOAD_1 * STOP_N_M;
    return law;
}
