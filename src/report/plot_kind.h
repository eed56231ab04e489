/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_PLOT_KIND_H
#define REPORT_PLOT_KIND_H

/* Figures that can be drawn (plot.h). */

/* X(kind, name on the command line, what it shows). */
#define CP_PLOT_KINDS(X)                                                                           \
    X(CP_PLOT_RATES, "rates", "frontal crash rates with their intervals")                          \
    X(CP_PLOT_OLC, "olc", "distribution functions of OLC with their bands")                        \
    X(CP_PLOT_DELTA_V, "delta-v", "the same of delta-v")                                           \
    X(CP_PLOT_DIFFERENCE, "difference", "change of OLC against the baseline with intervals")       \
    X(CP_PLOT_FOREST, "forest", "rate ratio, or share avoided, of each scenario and of all")       \
    X(CP_PLOT_SEVERITY, "severity", "OLC against closing speed")                                   \
    X(CP_PLOT_MAP, "map", "crash configurations: offset, angle, closing speed")                    \
    X(CP_PLOT_SITES, "sites", "where they crash, a map for each network")                          \
    X(CP_PLOT_OUTCOMES, "outcomes", "counterfactual outcomes of each treatment")                   \
    X(CP_PLOT_BENEFIT, "benefit", "benefit in expected injured drivers")                           \
    X(CP_PLOT_RISK, "risk", "injury risk over delta-v, by each risk function")                     \
    X(CP_PLOT_CORRIDOR, "corridor", "pulse corridors of each variant")                             \
    X(CP_PLOT_ABOVE_OLC, "above-olc", "crashes above an OLC per vehicle-km, over that OLC")        \
    X(CP_PLOT_ABOVE_DELTA_V, "above-delta-v", "the same of delta-v")                               \
    X(CP_PLOT_CONVERGENCE, "convergence", "the headline over more and more replications")          \
    X(CP_PLOT_DOSE, "dose", "the headline over each swept parameter")

typedef enum cp_plot_kind {
#define CP_PLOT_NAME(kind, name, what) kind,
    CP_PLOT_KINDS(CP_PLOT_NAME)
#undef CP_PLOT_NAME
        CP_PLOT_KIND_COUNT
} cp_plot_kind;

#endif
