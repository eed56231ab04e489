/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit.h"

#include <stdlib.h>

bool cp_fit_draws_starts(const cp_fit *fit)
{
    return fit->generations == 0 && fit->starts > 1;
}

void cp_fit_destroy(cp_fit *fit)
{
    cp_reference_destroy(&fit->reference);
    for (size_t k = 0; k < fit->pulse_count; k++)
        cp_reference_pulse_destroy(&fit->pulses[k]);
    free(fit->pulses);
    free(fit->reference_path);
    free(fit->output_path);
    for (size_t k = 0; k < fit->input_count; k++)
        free(fit->input_path[k]);
    free(fit->input_path);
    *fit = (cp_fit){0};
}
