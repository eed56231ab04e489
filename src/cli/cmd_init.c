/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "core/file.h"
#include "core/installation.h"
#include "core/log.h"
#include "core/memory_stream.h"
#include "study/occasions.h"
#include "study/study_draft.h"
#include "study/study_file.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define EXAMPLE "left_turn"
#define EXAMPLE_S 600.0 /* of it: a minute of work in all */

typedef struct arguments {
    cp_args_input folder;
    const char *network; /* NULL: the example's */
} arguments;

static const struct argp_option OPTIONS[] = {
    {"network", 'n', "FILE.sumocfg", 0,
     "a SUMO configuration of your own, with its network and demand; it stays where it is "
     "(default: an example, copied into DIR)",
     0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->folder;
        return 0;
    case 'n':
        a->network = argument;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "DIR [--network FILE.sumocfg]",
    .doc = "Begin a study: write DIR/study.yaml, with comments, for a network of your own. "
           "Driver errors that have no place in it (red lights without traffic lights) are left "
           "out with the reason; duration, warm-up and step are proposed from the network."
           "\v"
           "Nothing that is there is overwritten.\n\n"
           "Examples:\n"
           "  crashpulse init my_study --network town/town.sumocfg\n"
           "  crashpulse init first_study\n",
    .children = CHILDREN,
};

// ---- paths ---------------------------------------------------------------------------------

static cp_status resolve(const char *path, char resolved[PATH_MAX], cp_error *error)
{
    return realpath(path, resolved) != NULL
               ? CP_OK
               : cp_fail(error, CP_BAD_INPUT, "%s: %s", path, strerror(errno));
}

// A file as seen from a folder, both resolved: "../../town/town.sumocfg".
static cp_status relative_path(const char *folder, const char *file, char *path, size_t size,
                               cp_error *error)
{
    // Behind the last '/' up to which they agree in whole names.
    size_t common = 0;
    for (size_t k = 0;; k++) {
        bool folder_ends = folder[k] == '/' || folder[k] == '\0';
        if (folder_ends && file[k] == '/')
            common = k + 1;
        if (folder[k] == '\0' || folder[k] != file[k])
            break;
    }
    size_t used = 0, length = strlen(folder);
    for (size_t k = common; k < length && used + 4 < size; k++)
        if (k == common || folder[k] == '/')
            used += (size_t)snprintf(path + used, size - used, "../");
    int rest = snprintf(path + used, size - used, "%s", file + common);
    return rest >= 0 && (size_t)rest < size - used
               ? CP_OK
               : cp_fail(error, CP_BAD_INPUT, "%s: the path is too long", file);
}

// Name of the study: that of the configuration, with '_' for what a name may not have.
static void name_of(const char *sumocfg, char name[65])
{
    const char *slash = strrchr(sumocfg, '/');
    snprintf(name, 65, "%.64s", slash != NULL ? slash + 1 : sumocfg);
    char *ending = strstr(name, ".sumocfg");
    if (ending != NULL && ending != name)
        *ending = '\0';
    for (char *c = name; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && strchr("_-.", *c) == NULL)
            *c = '_';
}

// ---- the example ---------------------------------------------------------------------------

static cp_status copy_new(const char *from, const char *to, cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    struct stat there;
    if (lstat(to, &there) == 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: is there already", to);
    cp_status status = cp_file_read(from, &content, &size, error);
    if (status == CP_OK)
        status = cp_file_write(to, content, size, error);
    free(content);
    return status;
}

static cp_status copy_example(const char *folder, char sumocfg[PATH_MAX], cp_error *error)
{
    static const char *const ENDING[] = {"net.xml", "rou.xml", "sumocfg"};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof ENDING / sizeof *ENDING; k++) {
        char part[128], from[PATH_MAX];
        snprintf(part, sizeof part, "sumo_scenarios/" EXAMPLE "/" EXAMPLE ".%s", ENDING[k]);
        status = cp_installation_find(CP_INSTALLED_DATA, part, from, sizeof from, error);
        int length = snprintf(sumocfg, PATH_MAX, "%s/" EXAMPLE ".%s", folder, ENDING[k]);
        if (status == CP_OK && (length < 0 || length >= PATH_MAX))
            status = cp_fail(error, CP_BAD_INPUT, "%s: the path is too long", folder);
        if (status == CP_OK)
            status = copy_new(from, sumocfg, error);
    }
    return status;
}

// ---- the study -----------------------------------------------------------------------------

static cp_status write_study(const char *sumocfg, const char *as_named, const char *path,
                             double longest_s, cp_error *error)
{
    cp_sumo_configuration configuration = {0};
    cp_network_survey survey = {0};
    char *text = NULL, name[65];
    size_t size = 0;
    name_of(sumocfg, name);
    cp_status status = cp_sumo_configuration_read(sumocfg, NULL, 0, &configuration, error);
    if (status == CP_OK)
        status = cp_network_survey_make(&configuration, &survey, error);
    if (status == CP_OK && survey.edges == 0)
        status =
            cp_fail(error, CP_BAD_INPUT,
                    "%s: names no network that can be read (net-file with edges in it)", sumocfg);
    if (status == CP_OK) {
        cp_study_draft draft = cp_study_draft_of(&configuration, &survey, longest_s);
        FILE *out = cp_memory_stream(&text, &size);
        if (out != NULL)
            cp_study_draft_write(&draft, &survey, name, as_named, out);
        if (out == NULL || fclose(out) != 0)
            status = cp_fail_memory(error, path);
    }
    if (status == CP_OK)
        status = cp_file_write(path, text, size, error);
    if (status == CP_OK && survey.departures + survey.flows == 0)
        cp_log_warning("%s: no vehicle departs in the files it names; a study needs traffic "
                       "(randomTrips.py of SUMO makes some)",
                       sumocfg);
    free(text);
    cp_network_survey_destroy(&survey);
    cp_sumo_configuration_destroy(&configuration);
    return status;
}

// What was written is read as 'run' will read it.
static cp_status check_study(const char *path, cp_error *error)
{
    cp_study study = {0};
    cp_status status = cp_study_load(path, &study, error);
    if (status == CP_OK)
        status = cp_study_tell_options(&study, error);
    if (status == CP_OK)
        status = cp_study_tell_occasions(&study, error);
    cp_study_destroy(&study);
    return status;
}

static cp_status make_folder(const char *folder, char study[PATH_MAX], cp_error *error)
{
    struct stat there;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be made: %s", folder, strerror(errno));
    int length = snprintf(study, PATH_MAX, "%s/study.yaml", folder);
    if (length < 0 || length >= PATH_MAX)
        return cp_fail(error, CP_BAD_INPUT, "%s: the path is too long", folder);
    if (lstat(study, &there) == 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: is there already; choose another DIR", study);
    return CP_OK;
}

cp_status cmd_init(int argc, char **argv, cp_error *error)
{
    arguments a = {.folder = {.one = "folder", .missing = "where to? DIR"}};
    cp_args_parse(&ARGP, argc, argv, &a);
    char sumocfg[PATH_MAX], folder[PATH_MAX], study[PATH_MAX], as_named[PATH_MAX];
    cp_status status = a.network != NULL ? resolve(a.network, sumocfg, error) : CP_OK;
    if (status == CP_OK)
        status = make_folder(a.folder.path, study, error);
    if (status == CP_OK && a.network == NULL)
        status = copy_example(a.folder.path, as_named, error);
    if (status == CP_OK && a.network == NULL)
        status = resolve(as_named, sumocfg, error);
    if (status == CP_OK)
        status = resolve(a.folder.path, folder, error);
    if (status == CP_OK)
        status = relative_path(folder, sumocfg, as_named, sizeof as_named, error);
    if (status == CP_OK)
        status = write_study(sumocfg, as_named, study, a.network == NULL ? EXAMPLE_S : 0.0, error);
    if (status == CP_OK)
        status = check_study(study, error);
    if (status == CP_OK)
        printf("wrote %s. Read and change it, then:\n"
               "  crashpulse plan %s\n"
               "  crashpulse run %s --db %s/study.db\n"
               "  crashpulse compare %s/study.db\n"
               "  crashpulse report %s/study.db --output %s/report.html\n",
               study, study, study, a.folder.path, a.folder.path, a.folder.path, a.folder.path);
    return status;
}
