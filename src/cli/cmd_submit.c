/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "core/file.h"
#include "core/installation.h"
#include "core/log.h"
#include "core/safe_text.h"
#include "study/study_file.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct arguments {
    cp_args_input input;
    const char *db_path;
    bool slurm;
    bool dry_run;
    long shards;
    long jobs;           /* worker processes of a task */
    bool free_outputs;   /* SUMO may write and connect where the scenarios say */
    bool allow_plugins;  /* the study's libraries are loaded */
    const char *options; /* further words for sbatch */
} arguments;

enum { SLURM = 256, SHARDS, DRY_RUN, SBATCH, FREE_OUTPUTS, ALLOW_PLUGINS };

static const struct argp_option OPTIONS[] = {
    {"slurm", SLURM, NULL, 0, "submit to Slurm (sbatch); the only queue there is so far", 0},
    {"db", 'd', "FILE", 0, "database of the whole study, on a disk that all nodes see", 0},
    {"shards", SHARDS, "N", 0, "tasks of the job array (default 4)", 0},
    {"jobs", 'j', "N", 0, "worker processes, and processors, of a task (default 1)", 0},
    {"sbatch", SBATCH, "WORDS", 0, "further words for sbatch: '--partition=long --time=2:00:00'",
     0},
    {"allow-sumo-outputs", FREE_OUTPUTS, NULL, 0,
     "let SUMO write and connect wherever the scenarios say, as 'crashpulse run' with it", 0},
    {"allow-plugins", ALLOW_PLUGINS, NULL, 0,
     "load the libraries that the study names, as 'crashpulse run' with it", 0},
    {"dry-run", DRY_RUN, NULL, 0, "write the scripts, submit nothing", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->input;
        return 0;
    case SLURM:
        a->slurm = true;
        return 0;
    case 'd':
        a->db_path = argument;
        return 0;
    case SHARDS:
        a->shards = cp_args_integer(state, "--shards", argument, 1, 10000);
        return 0;
    case 'j':
        a->jobs = cp_args_integer(state, "--jobs", argument, 1, 1024);
        return 0;
    case FREE_OUTPUTS:
        a->free_outputs = true;
        return 0;
    case ALLOW_PLUGINS:
        a->allow_plugins = true;
        return 0;
    case SBATCH:
        a->options = argument;
        return 0;
    case DRY_RUN:
        a->dry_run = true;
        return 0;
    case ARGP_KEY_END:
        cp_args_need(state, a->slurm, "to which queue? --slurm");
        cp_args_need(state, a->db_path != NULL, "where to? --db FILE");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "STUDY.yaml --slurm --db FILE",
    .doc = "Run a study on a cluster: a job array with one task a shard, each into a database of "
           "its own, and a job after it that merges them into --db."
           "\v"
           "Scripts, output of the jobs and the shards' databases stand in the folder FILE.slurm. "
           "Submitting again after a failure completes the study: what shards have done stays. "
           "Prints the two job ids.\n\n"
           "Example:\n"
           "  crashpulse submit study.yaml --slurm --db study.db --shards 32 --jobs 4 \\\n"
           "      --sbatch '--partition=short --time=1:00:00'\n",
    .children = CHILDREN,
};

// ---- the scripts ---------------------------------------------------------------------------

typedef struct paths {
    char program[PATH_MAX];
    char study[PATH_MAX];
    char db[PATH_MAX];
    char folder[PATH_MAX + 8];
    char array[PATH_MAX + 32];
    char merge[PATH_MAX + 32];
} paths;

// Absolute, for nodes that start in another folder; the file itself need not be there yet.
static cp_status absolute(const char *path, char result[PATH_MAX], cp_error *error)
{
    char folder[PATH_MAX];
    if (realpath(path, result) != NULL)
        return CP_OK;
    const char *slash = strrchr(path, '/');
    size_t length = slash != NULL ? (size_t)(slash - path) + 1 : 0;
    const char *name = slash != NULL ? slash + 1 : path;
    char parent[PATH_MAX];
    snprintf(parent, sizeof parent, "%.*s", (int)(length > 0 ? length : 1),
             length > 0 ? path : ".");
    if (realpath(parent, folder) == NULL || strlen(folder) + strlen(name) + 2 > PATH_MAX)
        return cp_fail(error, CP_BAD_INPUT, "%s: %s", path, strerror(errno));
    strcpy(result, folder);
    strcat(result, "/");
    strcat(result, name);
    return CP_OK;
}

static cp_status find_paths(const arguments *a, paths *p, cp_error *error)
{
    cp_status status = cp_installation_program(p->program, sizeof p->program, error);
    if (status == CP_OK)
        status = absolute(a->input.path, p->study, error);
    if (status == CP_OK)
        status = absolute(a->db_path, p->db, error);
    if (status != CP_OK)
        return status;
    // The scripts quote paths in '...'.
    if (strchr(p->program, '\'') || strchr(p->study, '\'') || strchr(p->db, '\''))
        return cp_fail(error, CP_BAD_INPUT, "paths with a ' in them cannot be submitted");
    // A line of a script is a command, or words for Slurm.
    if (!cp_text_is_plain(p->program) || !cp_text_is_plain(p->study) || !cp_text_is_plain(p->db))
        return cp_fail(error, CP_BAD_INPUT,
                       "paths with ends of lines or control characters cannot be submitted");
    snprintf(p->folder, sizeof p->folder, "%s.slurm", p->db);
    snprintf(p->array, sizeof p->array, "%s/array.sh", p->folder);
    snprintf(p->merge, sizeof p->merge, "%s/merge.sh", p->folder);
    if (mkdir(p->folder, 0777) != 0 && errno != EEXIST)
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be made: %s", p->folder, strerror(errno));
    return CP_OK;
}

static cp_status write_script(const char *path, const char *text, cp_error *error)
{
    cp_status status = cp_file_write(path, text, strlen(text), error);
    if (status == CP_OK && chmod(path, 0755) != 0)
        status = cp_fail(error, CP_IO_FAILED, "%s: %s", path, strerror(errno));
    return status;
}

static cp_status write_scripts(const arguments *a, const paths *p, cp_error *error)
{
    char text[8 * PATH_MAX];
    snprintf(text, sizeof text,
             "#!/bin/sh\n"
             "# Written by 'crashpulse submit': one shard of the study a task.\n"
             "#SBATCH --job-name=crashpulse\n"
             "#SBATCH --array=1-%ld\n"
             "#SBATCH --ntasks=1 --cpus-per-task=%ld\n"
             "#SBATCH --output='%s/shard_%%a.log'\n"
             "exec '%s' run '%s' --db '%s'/shard_\"$SLURM_ARRAY_TASK_ID\".db \\\n"
             "    --shard \"$SLURM_ARRAY_TASK_ID\"/%ld --jobs %ld%s%s\n",
             a->shards, a->jobs, p->folder, p->program, p->study, p->folder, a->shards, a->jobs,
             a->free_outputs ? " --allow-sumo-outputs" : "",
             a->allow_plugins ? " --allow-plugins" : "");
    cp_status status = write_script(p->array, text, error);
    snprintf(
        text, sizeof text,
        "#!/bin/sh\n"
        "# Written by 'crashpulse submit': puts the shards together when all tasks have ended.\n"
        "#SBATCH --job-name=crashpulse-merge\n"
        "#SBATCH --ntasks=1\n"
        "#SBATCH --output='%s/merge.log'\n"
        "'%s' merge '%s' '%s'/shard_*.db && exec '%s' status '%s'\n",
        p->folder, p->program, p->db, p->folder, p->program, p->db);
    if (status == CP_OK)
        status = write_script(p->merge, text, error);
    return status;
}

// ---- submitting ----------------------------------------------------------------------------

// Run sbatch --parsable and read the id of the job from its only line.
static cp_status submit(const char *words, const char *script, char id[64], cp_error *error)
{
    char command[3 * PATH_MAX];
    snprintf(command, sizeof command, "sbatch --parsable %s '%s'", words, script);
    fflush(stdout);
    // NOLINTNEXTLINE(cert-env33-c): the words of --sbatch are for a shell, paths are checked
    FILE *pipe = popen(command, "r");
    if (pipe == NULL)
        return cp_fail(error, CP_IO_FAILED, "sbatch: %s", strerror(errno));
    bool read = fgets(id, 64, pipe) != NULL;
    int ended = pclose(pipe);
    id[read ? strcspn(id, ";\n") : 0] = '\0';
    if (!read || ended != 0 || !isdigit((unsigned char)id[0]))
        return cp_fail(error, CP_RUN_FAILED, "sbatch failed (its message stands above): %s",
                       command);
    return CP_OK;
}

static cp_status submit_both(const arguments *a, const paths *p, cp_error *error)
{
    char id[64], merge_id[64], words[PATH_MAX];
    const char *options = a->options != NULL ? a->options : "";
    cp_status status = submit(options, p->array, id, error);
    if (status != CP_OK)
        return status;
    // After the tasks, however they ended: what is done is merged, what is missing is said.
    snprintf(words, sizeof words, "--dependency=afterany:%s %s", id, options);
    status = submit(words, p->merge, merge_id, error);
    if (status == CP_OK)
        printf("%s\n%s\n", id, merge_id);
    return status;
}

cp_status cmd_submit(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = CP_ARGS_STUDY, .shards = 4, .jobs = 1};
    cp_args_parse(&ARGP, argc, argv, &a);

    // A study that does not load is not worth a place in the queue.
    cp_study study = {0};
    paths p;
    cp_status status = cp_study_load(a.input.path, &study, error);
    if (status != CP_OK)
        return status;
    cp_study_destroy(&study);
    status = find_paths(&a, &p, error);
    if (status == CP_OK)
        status = write_scripts(&a, &p, error);
    if (status != CP_OK)
        return status;
    cp_log_info("scripts and shards in %s", p.folder);
    return a.dry_run ? CP_OK : submit_both(&a, &p, error);
}
