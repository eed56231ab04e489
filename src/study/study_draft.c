/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_draft.h"

#include "control/control.h"
#include "core/safe_text.h"
#include "core/yaml_file.h"

#include <math.h>
#include <string.h>

#define LONGEST_S 3600.0
#define UNKNOWN_S 900.0
#define AFTER_LAST_S 300.0 /* the last cars are to arrive */
#define SLOW_M_S 8.33      /* 30 km/h, stops included */
#define STEP_LARGEST_S 0.1 /* functions react within fractions of a second */

// ---- what is proposed ----------------------------------------------------------------------

static double number_of(const cp_sumo_configuration *configuration, const char *option,
                        double standard)
{
    const cp_sumo_setting *setting = cp_sumo_configuration_find(configuration, option);
    double value = standard;
    return setting != NULL && cp_parse_number(setting->value, &value) ? value : standard;
}

static double duration_of(const cp_sumo_configuration *configuration,
                          const cp_network_survey *survey, double longest_s)
{
    double length_s = cp_sumo_configuration_length_s(configuration);
    double begin_s = number_of(configuration, "begin", 0.0);
    if (!isfinite(length_s) && isfinite(survey->last_departure_s))
        length_s = fmax(survey->last_departure_s - begin_s, 0.0) + AFTER_LAST_S;
    if (!isfinite(length_s) || length_s <= 0.0)
        return UNKNOWN_S;
    // Whole seconds, but never beyond the end of the configuration.
    return length_s < 1.0 ? length_s
                          : floor(fmin(length_s, longest_s > 0.0 ? longest_s : LONGEST_S));
}

cp_study_draft cp_study_draft_of(const cp_sumo_configuration *configuration,
                                 const cp_network_survey *survey, double longest_s)
{
    double duration_s = duration_of(configuration, survey, longest_s);
    double across_s = survey->diagonal_m / SLOW_M_S;
    double step_s = fmin(number_of(configuration, "step-length", 1.0), STEP_LARGEST_S);
    return (cp_study_draft){
        .duration_s = duration_s,
        .warmup_s = floor(fmin(across_s, duration_s / 3.0) / 10.0) * 10.0,
        .step_length_s = fmax(round(step_s * 1e3), 1.0) / 1e3,
        .fits_junctions = survey->yielding > 0,
        .fits_lights = survey->lights > 0,
        .fits_overtaking = survey->may_overtake > 0,
        .fits_drift = survey->two_way > 0,
    };
}

// ---- writing -------------------------------------------------------------------------------

typedef struct proposed_error {
    const char *model;
    const char *why_not; /* when it does not fit */
    bool fits;
} proposed_error;

// A driver error with all its parameters at their defaults; one that does not fit as a comment.
static void write_error(const proposed_error *proposed, FILE *file)
{
    const cp_control_type *type = cp_control_type_find(CP_CONTROL_DRIVER_ERROR, proposed->model);
    const char *mark = proposed->fits ? "" : "# ";
    fprintf(file, "      # %s%s%s\n", type->what,
            proposed->fits ? "" : " (left out: ", proposed->fits ? "" : proposed->why_not);
    fprintf(file, "      %s- model: %s\n", mark, type->name);
    fprintf(file, "      %s  parameters: {%s: %g}\n", mark, type->parameters[0].name,
            type->parameters[0].standard);
}

static void write_errors(const cp_study_draft *draft, FILE *file)
{
    const proposed_error ERROR[] = {
        {"failed_to_see", "nobody gives way at a junction of this network)", draft->fits_junctions},
        {"misjudged_gap", "nobody gives way at a junction of this network)", draft->fits_junctions},
        {"red_light", "this network has no traffic light)", draft->fits_lights},
        {"risky_overtaking",
         "no lane may overtake over the oncoming one; netconvert --opposites.guess makes them)",
         draft->fits_overtaking},
        {"lane_drift", "no road of this network has an oncoming lane)", draft->fits_drift},
        {"late_braking", "", true},
    };
    fputs("    # How drivers err. All probabilities and rates are assumed, not calibrated to\n"
          "    # accident statistics: figures hold for these errors. Parameters not given have\n"
          "    # their defaults; 'crashpulse plan' shows all of them.\n"
          "    driver_errors:\n",
          file);
    for (size_t k = 0; k < sizeof ERROR / sizeof *ERROR; k++)
        write_error(&ERROR[k], file);
}

// The vehicle types of the scenario, behind a word, as far as a few lines go.
static void list_types(const cp_network_survey *survey, FILE *file)
{
    const char *id;
    json_t *class;
    size_t listed = 0;
    json_object_foreach(survey->types, id, class)
    {
        if (listed == 20) {
            fputs("#     ...\n", file);
            return;
        }
        fputs(listed++ == 0 ? "#   Types of this scenario, with their vClass:\n#     " : "#     ",
              file);
        cp_text_print(file, id, "");
        fputs(": ", file);
        cp_text_print(file, json_string_value(class), "");
        fputc('\n', file);
    }
}

static void write_types(const cp_network_survey *survey, FILE *file)
{
    fputs(
        "# What the cars of SUMO crash as: each is drawn from a vehicle class by the vClass and\n"
        "# size of its type. Types without one are named at the end of a run, with the line that\n"
        "# maps them.\n"
        "vehicles:\n"
        "  fleet: default\n"
        "#   types:\n"
        "#     - {type: my_type, model: van}   # a shipped model, or a file: ./my_van.yaml\n",
        file);
    list_types(survey, file);
}

static void write_head(const cp_study_draft *draft, const char *name, FILE *file)
{
    fprintf(file,
            "# A study of crashpulse: traffic with erring drivers, with and without a function.\n"
            "# Every key: 'crashpulse reference'. Look at it: crashpulse plan STUDY.yaml\n"
            "study: %s\n"
            "question: \"How much less severe do frontal crashes get with AEB?\"\n"
            "design: paired_seeds        # the same traffic and errors in every variant;\n"
            "                            # or independent, counterfactual\n"
            "seed: 1                     # same seed, same results\n"
            "replications: 4             # of each variant; more narrow the intervals (20 for a\n"
            "                            # paper), and can be added later: run again\n",
            name);
    fprintf(file,
            "duration_s: %-15.10g # simulated time of a replication, the warm-up included\n"
            "warmup_s: %-17.10g # not counted: the network fills\n"
            "step_length_s: %-12.10g # of SUMO; functions need 0.1 s or less\n",
            draft->duration_s, draft->warmup_s, draft->step_length_s);
}

void cp_study_draft_write(const cp_study_draft *draft, const cp_network_survey *survey,
                          const char *name, const char *sumocfg, FILE *file)
{
    write_head(draft, name, file);
    fprintf(file, "scenarios:\n  - name: %s\n    sumocfg: ", name);
    cp_text_write_yaml(file, sumocfg);
    fputc('\n', file);
    fprintf(file,
            "    # %zu roads (%zu two-way), %zu traffic lights, %zu connections that give way,\n"
            "    # %zu lanes that may overtake over the oncoming one, %.0f km/h at most.\n",
            survey->edges, survey->two_way, survey->lights, survey->yielding, survey->may_overtake,
            survey->speed_max_m_s * 3.6);
    write_errors(draft, file);
    fputs("# What is compared: the first without functions, the others with.\n"
          "variants:\n"
          "  - name: baseline\n"
          "    functions: []\n"
          "  - name: aeb\n"
          "    functions:\n"
          "      - function: aeb         # also: fcw, elk, isa\n"
          "        parameters: {ttc_s: 1.2, deceleration_m_s2: 8}   # of no product; assumed\n",
          file);
    write_types(survey, file);
    fputs("# What only a person can say of the study; the report prints what is missing.\n"
          "# assessment:\n"
          "#   target_population: \"...\"\n"
          "#   limitations: \"...\"\n",
          file);
}
