/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/report.h"

#include "core/file.h"
#include "report/page.h"
#include "report/page_data.h"

#include <stdlib.h>
#include <string.h>

// Files of reports/ and the drawing library, embedded at build time.
extern const unsigned char cp_page_html[];
extern const unsigned char cp_page_css[];
extern const unsigned char cp_page_js[];
extern const unsigned char cp_page_d3_notice[];
extern const unsigned char cp_page_d3[];
extern const unsigned char cp_scorecard_csv[]; /* db/validation/scorecard.csv */

// What stands behind the empty line of an answer: its conditions. Ends the answer there.
static const char *cut_conditions(char *answer)
{
    char *line = strstr(answer, "\n\n");
    if (!line)
        return "";
    *line = '\0';
    return line + 2;
}

static cp_status write_page(const cp_study_data *data, const json_t *page_data, char *answer,
                            const char *path, cp_error *error)
{
    char *conditions = cp_page_escape(cut_conditions(answer));
    char *title = cp_page_escape(data->name), *safe_answer = cp_page_escape(answer);
    char *notice = cp_page_escape((const char *)cp_page_d3_notice),
         *json = cp_page_json_text(page_data);
    char *page = NULL;
    size_t size = 0;
    cp_status status;
    if (!title || !safe_answer || !conditions || !notice || !json) {
        status = cp_fail_memory(error, "a report");
        goto done;
    }
    const cp_page_part parts[] = {
        {"version", CRASHPULSE_VERSION},
        {"title", title},
        {"answer", safe_answer},
        {"conditions", conditions},
        {"style", (const char *)cp_page_css},
        {"d3", (const char *)cp_page_d3},
        {"d3_notice", notice},
        {"script", (const char *)cp_page_js},
        {"data", json},
        {"scorecard", (const char *)cp_scorecard_csv},
    };
    status = cp_page_fill((const char *)cp_page_html, parts, sizeof parts / sizeof *parts, &page,
                          &size, error);
    if (status == CP_OK)
        status = cp_file_write(path, page, size, error);

done:
    free(page);
    free(json);
    free(notice);
    free(safe_answer);
    free(conditions);
    free(title);
    return status;
}

cp_status cp_report_write(cp_store *store, const char *baseline, json_t *controls, const char *path,
                          cp_error *error)
{
    cp_study_data data;
    json_t *page_data = NULL;
    char *answer = NULL;
    size_t variant = 0;
    cp_comparison_options options = cp_comparison_options_default();
    cp_model_ensemble ensemble = {0};
    cp_status status = cp_study_data_read(store, &data, error);
    if (status == CP_OK && data.replication_count == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: no replication is finished yet",
                         cp_store_path(store));
    if (status == CP_OK)
        status = cp_study_data_variant(&data, baseline, &variant, error);
    // What the ensemble of the vehicle models leaves open is part of the answer where there is one.
    if (status == CP_OK)
        status = cp_model_ensemble_read(store, &data, &ensemble, error);
    options.ensemble = &ensemble;
    if (status == CP_OK)
        status = cp_page_data(store, &data, variant, &options, &page_data, &answer, error);
    if (status == CP_OK && controls && json_object_set(page_data, "controls", controls) != 0)
        status = cp_fail_memory(error, "a report");
    if (status == CP_OK)
        status = write_page(&data, page_data, answer, path, error);
    json_decref(page_data);
    free(answer);
    cp_model_ensemble_destroy(&ensemble);
    cp_study_data_destroy(&data);
    return status;
}
