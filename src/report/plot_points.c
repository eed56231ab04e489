/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot_data.h"

#include "analysis/any_vehicle.h"
#include "analysis/slice_sample.h"
#include "core/units.h"

#include <math.h>
#include <stdlib.h>

// ---- single crashes ----------------------------------------------------------------------------

// Columns of a vehicle: x, y, colour (km/h). False: not drawn.
static bool coordinates(const cp_study_vehicle *v, double x_m, double y_m, cp_plot_kind kind,
                        double xyz[3])
{
    xyz[2] = cp_km_h_from_m_s(v->closing_speed_m_s);
    if (kind == CP_PLOT_SEVERITY) {
        xyz[0] = xyz[2];
        xyz[1] = v->olc_g;
        return v->olc == CP_OLC_KNOWN;
    }
    xyz[0] = kind == CP_PLOT_MAP ? v->lateral_offset_m : x_m;
    xyz[1] = kind == CP_PLOT_MAP ? cp_deg_from_rad(v->angle_rad) : y_m;
    return v->role == 'a';
}

// A vehicle of the study or, behind them, a treated one, if it belongs to a block; scenario:
// SIZE_MAX for all.
static bool point_of(const cp_plot *p, size_t k, size_t scenario, size_t variant, cp_plot_kind kind,
                     double xyz[3])
{
    cp_any_vehicle v = cp_any_vehicle_at(p->data, k);
    return v.variant == variant && (scenario == SIZE_MAX || v.replication->scenario == scenario) &&
           cp_plot_has_vehicle(p, v.vehicle, v.treated ? SIZE_MAX : k) &&
           coordinates(v.vehicle, v.x_m, v.y_m, kind, xyz);
}

static void put_points(cp_plot *p, size_t scenario, size_t variant, cp_plot_kind kind)
{
    char title[CP_PLOT_TITLE_SIZE];
    if (scenario == SIZE_MAX)
        snprintf(title, sizeof title, "%.400s", cp_plot_name(p, variant));
    else
        snprintf(title, sizeof title, "%.200s: %.200s", p->data->scenario[scenario].name,
                 cp_plot_name(p, variant));
    cp_plot_begin_block(p, variant, title);
    fputs(CP_PLOT_NOTHING, p->out);
    for (size_t k = 0; k < cp_any_vehicle_count(p->data); k++) {
        double xyz[3];
        if (!point_of(p, k, scenario, variant, kind, xyz))
            continue;
        fprintf(p->out, "%.6g\t%.6g\t%.6g\n", xyz[0], xyz[1], xyz[2]);
        p->drawn++;
    }
}

/* The part of a plane that a map shows. */
typedef struct box {
    double from[2];
    double to[2];
} box;

#define MAP_MARGIN_M 25.0     /* around what is on it, at least */
#define MAP_MARGIN_1 0.05     /* of its extent, on each side */
#define MAP_SHORT_SIDE_1 0.35 /* of the long one, at least */

// Around all points of a scenario; false when it has none.
static bool box_of(const cp_plot *p, size_t scenario, const size_t *variant, size_t count, box *of)
{
    double xyz[3];
    *of = (box){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (size_t k = 0; k < cp_any_vehicle_count(p->data); k++)
        for (size_t v = 0; v < count; v++)
            if (point_of(p, k, scenario, variant[v], CP_PLOT_SITES, xyz))
                for (int d = 0; d < 2; d++) {
                    of->from[d] = fmin(of->from[d], xyz[d]);
                    of->to[d] = fmax(of->to[d], xyz[d]);
                }
    if (!(of->from[0] <= of->to[0]))
        return false;
    double half[2], longest = 0.0;
    for (int d = 0; d < 2; d++) {
        half[d] = fmax((0.5 + MAP_MARGIN_1) * (of->to[d] - of->from[d]), MAP_MARGIN_M);
        longest = fmax(longest, half[d]);
    }
    for (int d = 0; d < 2; d++) {
        double middle = 0.5 * (of->from[d] + of->to[d]);
        half[d] = fmax(half[d], MAP_SHORT_SIDE_1 * longest);
        of->from[d] = middle - half[d];
        of->to[d] = middle + half[d];
    }
    return true;
}

// Sites lie in the coordinates of their own network: a map each. Everything else is one figure.
cp_status cp_plot_points(cp_plot *p, cp_plot_kind kind, cp_error *error)
{
    size_t *variant = calloc(p->data->variant_count + 1, sizeof *variant);
    if (!variant)
        return cp_fail_memory(error, "a figure");
    size_t count = cp_plot_variants(p, variant);
    for (size_t s = 0; s < p->data->scenario_count && kind == CP_PLOT_SITES; s++) {
        box of;
        if (!box_of(p, s, variant, count, &of))
            continue;
        cp_plot_begin_panel(p);
        fprintf(p->boxes, "%.6g %.6g %.6g %.6g ", of.from[0], of.to[0], of.from[1], of.to[1]);
        for (size_t k = 0; k < count; k++)
            put_points(p, s, variant[k], kind);
    }
    for (size_t k = 0; k < count && kind != CP_PLOT_SITES; k++)
        put_points(p, SIZE_MAX, variant[k], kind);
    free(variant);
    return CP_OK;
}

// ---- counterfactual outcomes -------------------------------------------------------------------

cp_status cp_plot_outcomes(cp_plot *p, cp_error *error)
{
    static const cp_outcome ORDER[] = {CP_OUTCOME_AVOIDED,          CP_OUTCOME_MITIGATED,
                                       CP_OUTCOME_UNCHANGED,        CP_OUTCOME_AGGRAVATED,
                                       CP_OUTCOME_CHANGED_OPPONENT, CP_OUTCOME_INVALID};
    const cp_comparison *c = p->comparison;
    if (c->counterfactual_count == 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "outcomes are of studies with the design counterfactual only");
    fputs("\"\"", p->out);
    for (size_t o = 0; o < 6; o++) {
        fputs("\t\"", p->out);
        for (const char *t = cp_outcome_text(ORDER[o]); *t; t++)
            fputc(*t == '_' ? ' ' : *t, p->out);
        fputc('"', p->out);
    }
    fputc('\n', p->out);
    for (size_t k = 0; k < c->counterfactual_count; k++) {
        cp_plot_text(p->out, cp_plot_name(p, c->counterfactual[k].variant));
        for (size_t o = 0; o < 6; o++)
            fprintf(p->out, "\t%zu", c->counterfactual[k].outcome[ORDER[o]]);
        fputc('\n', p->out);
        p->drawn += c->counterfactual[k].crashes;
    }
    return CP_OK;
}
