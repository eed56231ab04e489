/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "matrix/matrix_result.h"

#include "core/gnuplot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TERMINAL_SIZE 160

/* What is drawn of a matrix: panels of columns x rows. An axis that is missing has one value. */
typedef struct layout {
    const cp_matrix *matrix;
    size_t panels, rows, columns;
} layout;

static size_t count_of(const cp_matrix *matrix, size_t axis)
{
    return axis < matrix->axis_count ? matrix->axis[axis].count : 1;
}

static layout layout_of(const cp_matrix *matrix)
{
    return (layout){.matrix = matrix,
                    .rows = count_of(matrix, 0),
                    .columns = count_of(matrix, 1),
                    .panels = count_of(matrix, 2)};
}

// Rows "column row speed text", a block a panel; km/h, 0 without an impact.
static void write_data(FILE *out, const layout *l, const cp_matrix_result *result)
{
    for (size_t panel = 0; panel < l->panels; panel++) {
        for (size_t row = 0; row < l->rows; row++)
            for (size_t column = 0; column < l->columns; column++) {
                const cp_cell_outcome *cell =
                    &result->with[(row * l->columns + column) * l->panels + panel];
                double km_h = cell->is_impact ? 3.6 * cell->impact_m_s : NAN;
                fprintf(out, "%zu\t%zu\t%.6g\t", column, row, isnan(km_h) ? 0.0 : km_h);
                if (isnan(km_h))
                    fputs(cell->touch[0] != '\0' ? "touch\n" : "avoided\n", out);
                else
                    fprintf(out, "%.1f\n", km_h);
            }
        fputs("\n\n", out);
    }
}

static void write_ticks(FILE *out, const char *which, const cp_matrix *matrix, size_t axis)
{
    fprintf(out, "set %stics (", which);
    for (size_t k = 0; k < count_of(matrix, axis); k++)
        fprintf(out, "%s\"%.6g\" %zu", k > 0 ? ", " : "",
                axis < matrix->axis_count ? matrix->axis[axis].values[k] : 0.0, k);
    fputs(") scale 0\n", out);
    if (axis < matrix->axis_count)
        fprintf(out, "set %slabel \"%s\"\n", which,
                cp_cell_parameter_name(matrix->axis[axis].parameter));
}

// Numbers and names of parameters, which are ours, go into the script; no text of the file does.
static void write_script(FILE *out, const layout *l, const cp_matrix_result *result,
                         const char *terminal)
{
    const cp_matrix *matrix = l->matrix;
    double fastest_km_h = 1.0;
    for (size_t k = 0; k < result->count; k++)
        if (result->with[k].is_impact)
            fastest_km_h = fmax(fastest_km_h, 3.6 * result->with[k].impact_m_s);
    fprintf(out,
            "set terminal %s\nset output \"figure\"\nset datafile separator \"\\t\"\n"
            "set palette defined (0 \"#f7fbff\", 0.5 \"#6baed6\", 1 \"#08306b\")\n"
            "set cbrange [0:%g]\nset cblabel \"own speed at impact, km/h\"\nunset key\n"
            "set xrange [-0.5:%g]\nset yrange [-0.5:%g]\nset style textbox opaque noborder\n",
            terminal, fastest_km_h, (double)l->columns - 0.5, (double)l->rows - 0.5);
    write_ticks(out, "x", matrix, 1);
    write_ticks(out, "y", matrix, 0);
    fprintf(out, "set multiplot layout %zu,1\n", l->panels);
    for (size_t panel = 0; panel < l->panels; panel++) {
        if (matrix->axis_count > 2)
            fprintf(out, "set title \"%s %.6g\"\n",
                    cp_cell_parameter_name(matrix->axis[2].parameter),
                    matrix->axis[2].values[panel]);
        fprintf(out,
                "plot \"data\" index %zu using 1:2:3 with image pixels, \"\" index %zu using 1:2:4 "
                "with labels tc rgb \"#111111\" boxed\n",
                panel, panel);
    }
    fputs("unset multiplot\nunset output\n", out);
}

static bool terminal_of(const char *path, const layout *l, char terminal[TERMINAL_SIZE])
{
    const char *ending = strrchr(path, '.');
    double width = fmax(520.0, 160.0 + 70.0 * (double)l->columns);
    double height = (double)l->panels * fmax(220.0, 110.0 + 32.0 * (double)l->rows);
    if (ending != NULL && strcmp(ending, ".svg") == 0)
        snprintf(terminal, TERMINAL_SIZE,
                 "svg size %.0f,%.0f font \"Helvetica,12\" noenhanced background \"#ffffff\"",
                 width, height);
    else if (ending != NULL && strcmp(ending, ".pdf") == 0)
        snprintf(terminal, TERMINAL_SIZE,
                 "pdfcairo size %.1fcm,%.1fcm font \"Helvetica,10\" noenhanced", width / 45.0,
                 height / 45.0);
    else
        return false;
    return true;
}

cp_status cp_matrix_plot(const cp_matrix *matrix, const cp_matrix_result *result, const char *path,
                         cp_error *error)
{
    char terminal[TERMINAL_SIZE], *script = NULL, *data = NULL;
    size_t script_size = 0, data_size = 0;
    const layout l = layout_of(matrix);
    if (!terminal_of(path, &l, terminal))
        return cp_fail(error, CP_BAD_INPUT, "%s: the file must end in .svg or .pdf", path);
    FILE *to_script = open_memstream(&script, &script_size);
    FILE *to_data = open_memstream(&data, &data_size);
    bool good = to_script != NULL && to_data != NULL;
    if (good) {
        write_script(to_script, &l, result, terminal);
        write_data(to_data, &l, result);
    }
    good = (to_script == NULL || fclose(to_script) == 0) && good;
    good = (to_data == NULL || fclose(to_data) == 0) && good;
    cp_status status = good ? cp_gnuplot_draw((const char *const[]){script}, 1, data, path, error)
                            : cp_fail_memory(error, "figure");
    free(script);
    free(data);
    return status;
}
