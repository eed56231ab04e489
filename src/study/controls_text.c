/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/controls_text.h"

static void write_controls(const cp_control_settings *settings, size_t count, FILE *out)
{
    if (count == 0)
        fputs("none", out);
    for (size_t k = 0; k < count; k++) {
        const cp_control_settings *control = &settings[k];
        const cp_library *library = control->library;
        fprintf(out, "%s%s", k > 0 ? "; " : "", cp_control_name(control));
        if (library != NULL)
            fprintf(out, " of %s", library->written);
        if (control->type->parameter_count == 0 && control->share_count == 0)
            continue;
        fputs(" (", out);
        for (size_t p = 0; p < control->type->parameter_count; p++)
            fprintf(out, "%s%s %.15g", p > 0 ? ", " : "", control->type->parameters[p].name,
                    control->parameter[p]);
        for (size_t p = 0; library != NULL && p < library->given_count; p++)
            fprintf(out, ", %s %s", library->given[p].name, library->given[p].text);
        for (size_t s = 0; s < control->share_count; s++)
            fprintf(out, "%s %s %.15g", s > 0 ? "," : "; equipment", control->shares[s].type,
                    control->shares[s].penetration_1);
        fputc(')', out);
    }
}

void cp_controls_text_scenario(const cp_study *study, size_t k, FILE *out)
{
    const cp_study_scenario *scenario = &study->scenarios[k];
    fprintf(out, "scenario %s: driver errors ", scenario->name);
    write_controls(scenario->driver_errors, scenario->driver_error_count, out);
}

void cp_controls_text_variant(const cp_study *study, size_t k, FILE *out)
{
    const cp_study_variant *variant = &study->variants[k];
    fprintf(out, "variant %s: functions ", variant->name);
    write_controls(variant->functions, variant->function_count, out);
}

void cp_controls_text_study(const cp_study *study, const char *prefix, FILE *out)
{
    for (size_t k = 0; k < study->scenario_count; k++) {
        fputs(prefix, out);
        cp_controls_text_scenario(study, k, out);
        fputc('\n', out);
    }
    for (size_t k = 0; k < study->variant_count; k++) {
        fputs(prefix, out);
        cp_controls_text_variant(study, k, out);
        fputc('\n', out);
    }
}
