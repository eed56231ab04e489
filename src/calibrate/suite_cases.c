/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite_cases.h"

#include "calibrate/reference.h"
#include "calibrate/suite_struck.h"
#include "core/file.h"
#include "core/units.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Shares of the car's width tried, on either side, where a test's offset is not known.
static const double UNKNOWN_OVERLAP_1[] = {0.2, 0.4, 0.6, 0.8, 1.0};

// Offset at which the opponent covers a share of the first car's width from its left side (side_1 =
// +1) or its right; NAN stands for middle on middle.
static double offset_of_overlap(const cp_suite_case *row, double overlap_1, double side_1)
{
    double own_m = row->model[0].width_m;
    double other_m = row->is_pair ? row->model[1].width_m : row->barrier.width_m;
    return isnan(overlap_1) ? 0.0 : side_1 * (0.5 * (own_m + other_m) - overlap_1 * own_m);
}

static void name_listed_case(const cp_suite_class *class, const cp_suite_case *row, double speed,
                             double overlap_1, size_t sides, char *label, size_t size)
{
    int used = snprintf(label, size, "%g km/h", speed);
    if (class->against.count > 0)
        used += snprintf(label + used, size - (size_t)used, " against %.40s", row->model[1].name);
    if (!isnan(overlap_1))
        used += snprintf(label + used, size - (size_t)used, ", overlap %.3g", overlap_1);
    if (sides > 1 || row->side_1 < 0.0)
        used += snprintf(label + used, size - (size_t)used, ", %s",
                         row->side_1 > 0.0 ? "left" : "right");
    if (row->angle_rad != 0.0)
        snprintf(label + used, size - (size_t)used, ", %+g deg", cp_deg_from_rad(row->angle_rad));
}

// The barrier as the second vehicle.
static void set_barrier_opponent(cp_suite_case *row)
{
    row->model[1] = cp_vehicle_model_of_barrier(&row->barrier);
    row->is_pair = true;
    row->has_barrier = false;
}

// Every opponent with every speed, overlap, side and angle.
static cp_status listed_cases(const cp_suite *suite, const cp_suite_class *class,
                              const cp_vehicle_model *vehicle, cp_suite_cases *cases,
                              cp_error *error)
{
    size_t opponents = class->against.count > 0 ? class->against.count : 1;
    size_t speeds = class->speeds_km_h.count, sides = class->sides_1.count;
    size_t overlaps = class->overlaps_1.count > 0 ? class->overlaps_1.count : 1;
    size_t angles = class->angles_deg.count > 0 ? class->angles_deg.count : 1;
    size_t total = opponents * speeds * overlaps * sides * angles;
    cp_status status = cp_suite_cases_make(cases, total, error);
    for (size_t k = 0; status == CP_OK && k < total; k++) {
        size_t angle = k % angles, side = k / angles % sides,
               overlap = k / angles / sides % overlaps;
        size_t speed = k / angles / sides / overlaps % speeds;
        size_t opponent = k / angles / sides / overlaps / speeds;
        cp_suite_case *row = &cases->row[cases->count];
        *row = cp_suite_plain_case(class, vehicle);
        row->is_pair = class->against.count > 0;
        if (class->has_barrier && cp_barrier_is_party(&class->barrier))
            set_barrier_opponent(row);
        else if (row->is_pair && strcmp(class->against.text[opponent], "same") != 0)
            status =
                cp_suite_vehicle(suite->path, class->against.text[opponent], &row->model[1], error);
        row->side_1 = class->sides_1.value[side];
        row->speed_m_s[0] = cp_m_s_from_km_h(class->speeds_km_h.value[speed]);
        row->speed_m_s[1] = class->opponent_speeds_km_h.count > 0
                                ? cp_m_s_from_km_h(class->opponent_speeds_km_h.value[speed])
                            : row->model[1].is_barrier ? 0.0
                                                       : row->speed_m_s[0];
        if (class->angles_deg.count > 0)
            row->angle_rad = row->side_1 * cp_rad_from_deg(class->angles_deg.value[angle]);
        double overlap_1 = class->overlaps_1.count > 0 ? class->overlaps_1.value[overlap] : NAN;
        row->offset_m[0] = offset_of_overlap(row, overlap_1, row->side_1);
        name_listed_case(class, row, class->speeds_km_h.value[speed], overlap_1, sides, row->label,
                         sizeof row->label);
        cases->count++;
    }
    return status;
}

// A table of OLC values of the vehicle against its own barrier.
static cp_status olc_cases(const char *path, const cp_suite_class *class,
                           const cp_vehicle_model *vehicle, cp_suite_cases *cases, cp_error *error)
{
    cp_reference table = {0};
    cp_status status = cp_reference_load(path, &table, error);
    if (status == CP_OK)
        status = cp_suite_cases_make(cases, table.count, error);
    for (size_t k = 0; status == CP_OK && k < table.count; k++) {
        const cp_reference_case *test = &table.cases[k];
        cp_suite_case *row = &cases->row[cases->count++];
        *row = cp_suite_plain_case(class, vehicle);
        row->barrier = vehicle->barrier;
        row->has_barrier = true;
        row->speed_m_s[0] = cp_m_s_from_km_h(test->speed_km_h);
        row->offset_m[0] = 1e-3 * test->offset_mm;
        row->angle_rad = cp_rad_from_deg(test->angle_deg);
        row->reference[0][CP_SUITE_olc_g] = test->olc_g;
        snprintf(row->label, sizeof row->label, "%g km/h, %+g mm, %g deg", test->speed_km_h,
                 test->offset_mm, test->angle_deg);
    }
    cp_reference_destroy(&table);
    return status;
}

// "test 4363".
static cp_status name_test(const cp_csv_table *table, size_t k, cp_suite_case *row, cp_error *error)
{
    const char *test = NULL;
    cp_status status = cp_csv_table_text(table, k, "test", &test, error);
    if (status == CP_OK)
        snprintf(row->label, sizeof row->label, "test %.60s", test);
    return status;
}

// Small overlap tests against one barrier, with the state at separation.
static cp_status separation_case(const cp_csv_table *table, size_t k, const cp_suite_class *class,
                                 cp_suite_case *row, bool *use, cp_error *error)
{
    const char *barrier = NULL;
    cp_status status = cp_csv_table_text(table, k, "barrier", &barrier, error);
    *use = false;
    for (size_t n = 0; status == CP_OK && n < class->rows_with.count; n++)
        *use = *use || strcmp(barrier, class->rows_with.text[n]) == 0;
    if (!*use)
        return status;
    double overlap_1 = 0.0, *of = row->reference[0];
    const cp_suite_column columns[] = {
        {"overlap_1", 0.01, 1.0, &overlap_1},
        {"speed_m_s", 0.1, 60.0, &row->speed_m_s[0]},
        {"dvx_m_s", -60.0, 60.0, &of[CP_SUITE_separation_dvx_m_s]},
        {"dvy_m_s", -60.0, 60.0, &of[CP_SUITE_separation_dvy_m_s]},
        {"yaw_rate_deg_s", -1000.0, 1000.0, &of[CP_SUITE_yaw_rate_deg_s]},
    };
    status = cp_suite_read_columns(table, k, columns, sizeof columns / sizeof *columns, error);
    row->offset_m[0] = offset_of_overlap(row, overlap_1, row->side_1);
    return status == CP_OK ? name_test(table, k, row, error) : status;
}

// Two cars placed by their impact centre: distance and angle from each centre of gravity. The
// masses are in the inverse ratio of the changes of velocity, their geometric mean is the
// vehicle's.
static cp_status oblique_case(const cp_csv_table *table, size_t k, cp_suite_case *row,
                              cp_error *error)
{
    double heading_deg[2], centre_m[2], centre_deg[2];
    double *one = row->reference[0], *two = row->reference[1];
    const cp_suite_column columns[] = {
        {"speed_1_m_s", 0.0, 60.0, &row->speed_m_s[0]},
        {"speed_2_m_s", 0.0, 60.0, &row->speed_m_s[1]},
        {"heading_1_deg", -360.0, 360.0, &heading_deg[0]},
        {"heading_2_deg", -360.0, 360.0, &heading_deg[1]},
        {"centre_1_m", 0.0, 5.0, &centre_m[0]},
        {"centre_2_m", 0.0, 5.0, &centre_m[1]},
        {"centre_angle_1_deg", -180.0, 180.0, &centre_deg[0]},
        {"centre_angle_2_deg", -180.0, 180.0, &centre_deg[1]},
        {"delta_v_1_m_s", 0.1, 100.0, &one[CP_SUITE_delta_v_m_s]},
        {"delta_v_2_m_s", 0.1, 100.0, &two[CP_SUITE_delta_v_m_s]},
        {"yaw_rate_change_1_deg_s", -2000.0, 2000.0, &one[CP_SUITE_yaw_rate_deg_s]},
        {"yaw_rate_change_2_deg_s", -2000.0, 2000.0, &two[CP_SUITE_yaw_rate_deg_s]},
    };
    cp_status status =
        cp_suite_read_columns(table, k, columns, sizeof columns / sizeof *columns, error);
    if (status != CP_OK)
        return status;
    double ratio_1 = two[CP_SUITE_delta_v_m_s] / one[CP_SUITE_delta_v_m_s];
    cp_vec2 at_m = {0.0, 0.0}; // the impact centre as seen from the first car
    for (int c = 0; c < 2; c++) {
        double yaw_rad = cp_rad_from_deg(heading_deg[c]);
        cp_vec2 arm_m =
            cp_vec2_scale(cp_vec2_heading(yaw_rad + cp_rad_from_deg(centre_deg[c])), centre_m[c]);
        at_m = c == 0 ? arm_m : at_m;
        row->configuration.vehicle[c] = (cp_body_state){
            .cog_m = c == 0 ? (cp_vec2){0.0, 0.0} : cp_vec2_sub(at_m, arm_m),
            .yaw_rad = cp_wrap_angle(yaw_rad),
            .velocity_m_s = cp_vec2_scale(cp_vec2_heading(yaw_rad), row->speed_m_s[c])};
        row->configuration.side[c] = CP_SIDE_FRONT;
        double scale_1 = c == 0 ? sqrt(ratio_1) : 1.0 / sqrt(ratio_1);
        cp_suite_set_mass(&row->model[c], scale_1 * row->model[c].mass_kg);
    }
    row->is_placed = true;
    return name_test(table, k, row, error);
}

// Two cars whose offset is not known: several are tried.
static cp_status reconstructed_case(const cp_csv_table *table, size_t k, cp_suite_case *row,
                                    cp_error *error)
{
    double angle_deg = 0.0, mass_kg[2];
    const cp_suite_column columns[] = {
        {"speed_1_m_s", 0.0, 80.0, &row->speed_m_s[0]},
        {"speed_2_m_s", 0.0, 80.0, &row->speed_m_s[1]},
        {"angle_deg", -60.0, 60.0, &angle_deg},
        {"mass_1_kg", 500.0, 5000.0, &mass_kg[0]},
        {"mass_2_kg", 500.0, 5000.0, &mass_kg[1]},
        {"delta_v_1_m_s", 0.1, 100.0, &row->reference[0][CP_SUITE_delta_v_m_s]},
        {"delta_v_2_m_s", 0.1, 100.0, &row->reference[1][CP_SUITE_delta_v_m_s]},
    };
    cp_status status =
        cp_suite_read_columns(table, k, columns, sizeof columns / sizeof *columns, error);
    if (status != CP_OK)
        return status;
    row->angle_rad = cp_rad_from_deg(angle_deg);
    for (int c = 0; c < 2; c++)
        cp_suite_set_mass(&row->model[c], mass_kg[c]);
    const size_t overlaps = sizeof UNKNOWN_OVERLAP_1 / sizeof *UNKNOWN_OVERLAP_1;
    row->offset_count = 2 * overlaps;
    for (size_t o = 0; o < row->offset_count; o++)
        row->offset_m[o] =
            offset_of_overlap(row, UNKNOWN_OVERLAP_1[o / 2], o % 2 == 0 ? 1.0 : -1.0);
    return name_test(table, k, row, error);
}

static cp_status table_cases(const char *path, const cp_suite_class *class,
                             const cp_vehicle_model *vehicle, cp_suite_cases *cases,
                             cp_error *error)
{
    cp_csv_table table = {0};
    cp_status status = cp_csv_table_load(path, &table, error);
    if (status == CP_OK)
        status = cp_suite_cases_make(cases, table.row_count, error);
    for (size_t k = 0; status == CP_OK && k < table.row_count; k++) {
        bool use = true;
        cp_suite_case *row = &cases->row[cases->count];
        *row = cp_suite_plain_case(class, vehicle);
        row->is_pair = class->form != CP_SUITE_SEPARATION;
        if (class->form == CP_SUITE_SEPARATION)
            status = separation_case(&table, k, class, row, &use, error);
        else if (class->form == CP_SUITE_OBLIQUE)
            status = oblique_case(&table, k, row, error);
        else if (class->form == CP_SUITE_STRUCK)
            status = cp_suite_struck_case(&table, k, class, row, &use, error);
        else
            status = reconstructed_case(&table, k, row, error);
        cases->count += use;
    }
    if (status == CP_OK && cases->count == 0)
        status =
            cp_fail(error, CP_BAD_INPUT, "%s: no row has '%s'", path, class->rows_with.text[0]);
    cp_csv_table_destroy(&table);
    return status;
}

cp_status cp_suite_cases_of(const cp_suite *suite, const cp_suite_class *class,
                            const cp_vehicle_model *vehicle, const char *references,
                            cp_suite_cases *cases, cp_error *error)
{
    *cases = (cp_suite_cases){0};
    if (class->is_struck)
        return cp_suite_struck_listed(suite, class, vehicle, cases, error);
    if (class->form == CP_SUITE_LISTS)
        return listed_cases(suite, class, vehicle, cases, error);
    size_t size = strlen(class->table_path) + (references != NULL ? strlen(references) : 0) + 2;
    char *path = malloc(size);
    if (path == NULL)
        return cp_fail_memory(error, class->table_path);
    snprintf(path, size, "%s%s%s", class->is_reference ? references : "",
             class->is_reference ? "/" : "", class->table_path);
    cp_status status = CP_OK;
    if (class->is_reference && access(path, F_OK) != 0)
        snprintf(cases->skipped, sizeof cases->skipped, "%.120s is not among the references",
                 class->table_path);
    else
        status = class->form == CP_SUITE_OLC ? olc_cases(path, class, vehicle, cases, error)
                                             : table_cases(path, class, vehicle, cases, error);
    free(path);
    return status;
}
