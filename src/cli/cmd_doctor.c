/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "core/installation.h"
#include "core/scratch.h"
#include "crash/crash_configuration.h"
#include "crash/crash_simulation.h"
#include "crash/named_vehicle.h"
#include "run/child.h"
#include "run/confinement.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <spawn.h>
#include <stdarg.h>
#include <string.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

/* What must be there for the program to work, each looked at once. */

typedef enum finding { FINE, WANTED, NEEDED } finding;

typedef struct examination {
    cp_table table;
    bool is_ill; /* something needed is missing */
} examination;

static void note(examination *x, const char *what, finding found, const char *advice,
                 const char *format, ...) __attribute__((format(printf, 5, 6)));

static void note(examination *x, const char *what, finding found, const char *advice,
                 const char *format, ...)
{
    static const char *const WORD[] = {"ok", "warning", "missing"};
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    cp_table_text(&x->table, what);
    cp_table_text(&x->table, WORD[found]);
    cp_table_text(&x->table, text);
    cp_table_text(&x->table, found == FINE ? "" : advice);
    x->is_ill |= found == NEEDED;
}

// ---- programs of others --------------------------------------------------------------------

extern char **environ;

// Start a program of the PATH with --version; *pid and the end of a pipe that has its stdout, or
// -1.
static int start(const char *program, pid_t *pid)
{
    char *const words[] = {(char *)program, (char *)"--version", NULL};
    int ends[2];
    posix_spawn_file_actions_t actions;
    if (pipe(ends) != 0)
        return -1;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed == 0) {
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_addclose(&actions, ends[0]);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        failed = posix_spawnp(pid, program, &actions, NULL, words, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    close(ends[1]);
    if (failed == 0)
        return ends[0];
    close(ends[0]);
    return -1;
}

// First line of what a program says of its version; false when there is none that ends well.
static bool first_line(const char *program, char *line, int size)
{
    pid_t pid = 0;
    int code = 0;
    int end = start(program, &pid);
    FILE *said = end >= 0 ? fdopen(end, "r") : NULL;
    bool there = said != NULL && fgets(line, size, said) != NULL;
    line[there ? strcspn(line, "\n") : 0] = '\0';
    // To its end: one that nobody reads on for fails.
    while (there && fgetc(said) != EOF)
        continue;
    if (said != NULL)
        fclose(said);
    else if (end >= 0)
        close(end);
    return end >= 0 && waitpid(pid, &code, 0) == pid && WIFEXITED(code) && WEXITSTATUS(code) == 0 &&
           there;
}

static void look_at_program(examination *x, const char *name, finding if_not, const char *package,
                            const char *use)
{
    char line[256], advice[512];
    snprintf(advice, sizeof advice, "apt-get install %s (%s)", package, use);
    bool there = first_line(name, line, sizeof line);
    note(x, name, there ? FINE : if_not, advice, "%s", there ? line : "not found in PATH");
}

static void look_at_programs(examination *x)
{
    char line[256];
    bool there = first_line("sumo", line, sizeof line);
    bool known = there && strstr(line, " 1.15.") != NULL;
    note(x, "sumo",
         known   ? FINE
         : there ? WANTED
                 : NEEDED,
         there ? "results were checked with SUMO 1.15; run the tests before trusting another"
               : "apt-get install sumo (traffic)",
         "%s", there ? line : "not found in PATH");
    look_at_program(x, "netconvert", WANTED, "sumo", "makes networks");
    look_at_program(x, "sqlite3", WANTED, "sqlite3", "'crashpulse sql DB' without a query");
    look_at_program(x, "gnuplot", WANTED, "gnuplot-nox", "'crashpulse plot'");
}

// ---- parts of our own ----------------------------------------------------------------------

static void look_at_worker(examination *x)
{
    static const char *const WORDS[] = {"crashpulse-worker", "--version", NULL};
    char path[PATH_MAX];
    cp_error error = {0};
    cp_child child = {0};
    cp_child_end end = {.exit_code = 1};
    cp_status status = cp_child_find_worker(NULL, path, sizeof path, &error);
    if (status == CP_OK)
        status = cp_child_start(path, WORDS, &child, &error);
    if (status == CP_OK)
        cp_child_wait(&child, 60.0, &end);
    bool good = status == CP_OK && end.exit_code == 0;
    note(x, "worker, libsumo", good ? FINE : NEEDED,
         "install crashpulse again, with the package sumo it was built against", "%s",
         good              ? path
         : status == CP_OK ? end.reason
                           : error.text);
}

static void look_at_parts(examination *x)
{
    static const struct {
        cp_installed_place place;
        const char *name, *what, *use;
    } PART[] = {
        {CP_INSTALLED_LIBRARY, "crashpulse_sql.so", "SQL functions",
         "install crashpulse again: median(), olc() and the like are missing in 'crashpulse sql'"},
        {CP_INSTALLED_DATA, "sumo_scenarios", "example scenarios",
         "install crashpulse again: 'crashpulse init' without --network needs them"},
    };
    for (size_t k = 0; k < sizeof PART / sizeof *PART; k++) {
        char path[PATH_MAX];
        cp_error error = {0};
        cp_status status =
            cp_installation_find(PART[k].place, PART[k].name, path, sizeof path, &error);
        bool there = status == CP_OK && access(path, R_OK) == 0;
        note(x, PART[k].what, there ? FINE : WANTED, PART[k].use, "%s%s",
             status == CP_OK ? path : error.text, there || status != CP_OK ? "" : ": not there");
    }
}

// One crash whose OLC is known to lie about where it lies.
static void look_at_crash(examination *x)
{
    cp_vehicle_model car;
    cp_crash_configuration configuration;
    cp_crash_result result = {0};
    cp_error error = {0};
    cp_crash_options options = cp_crash_options_default();
    bool is_double = cp_crash_library_is_double();
    note(x, "ODE, double precision", is_double ? FINE : NEEDED,
         "install Debian's libode8, which has double precision", "%s",
         is_double ? "yes" : "single precision: results would be worthless");
    cp_status status = cp_named_vehicle_load(NULL, "honda_accord_2014", &car, &error);
    if (status == CP_OK)
        status = cp_crash_configuration_from_description(&car, NULL, NULL, 56.0 / 3.6, 0.0, 0.0,
                                                         0.0, &configuration, &error);
    if (status == CP_OK && is_double)
        status = cp_crash_library_begin(&error);
    if (status == CP_OK && is_double) {
        status = cp_crash_simulate(&car, NULL, &configuration, &options, &result, &error);
        cp_crash_library_end();
    }
    double olc_g = result.severity[0].olc.olc_g;
    bool plausible = status == CP_OK && olc_g > 20.0 && olc_g < 50.0;
    note(x, "a crash at 56 km/h", plausible ? FINE : NEEDED, "report this with its message",
         status == CP_OK ? "OLC %.2f g" : "%.0f: no crash", status == CP_OK ? olc_g : NAN);
    cp_crash_result_destroy(&result);
}

// ---- the system ----------------------------------------------------------------------------

static void look_at_folder(examination *x, const char *what, const char *path, finding if_not,
                           const char *advice)
{
    struct statvfs space;
    bool writable = access(path, W_OK | X_OK) == 0;
    const char *why = writable ? "" : strerror(errno);
    double free_mb =
        statvfs(path, &space) == 0 ? (double)space.f_bavail * (double)space.f_frsize / 1e6 : NAN;
    bool good = writable && !(free_mb < 100.0);
    if (writable)
        note(x, what, good ? FINE : if_not, advice, "%s: %.0f MB free", path, free_mb);
    else
        note(x, what, if_not, advice, "%s: %s", path, why);
}

static void look_at_system(examination *x)
{
    look_at_folder(x, "working folder", ".", WANTED,
                   "give --db and --output a folder that you may write, with room");
    look_at_folder(x, "temporary files", cp_scratch_folder(), NEEDED,
                   "set TMPDIR to a folder that you may write, with 100 MB free");
    look_at_folder(x, "shared memory", "/dev/shm", WANTED,
                   "start the container with --shm-size=256m");
    bool confined = cp_confinement_has_folders();
    note(x, "Landlock", confined ? FINE : WANTED,
         "Linux 5.13 or later keeps files of strangers from writing elsewhere (SECURITY.md)", "%s",
         confined ? "workers are kept to their folders" : "this system has none");
    note(x, "processors", FINE, "", "%ld", sysconf(_SC_NPROCESSORS_ONLN));
}

// ---- the command ---------------------------------------------------------------------------

static error_t parse(int key, char *argument, struct argp_state *state)
{
    if (key == ARGP_KEY_INIT) {
        state->child_inputs[0] = state->input;
        return 0;
    }
    if (key == ARGP_KEY_ARG)
        argp_error(state, "takes no argument, found '%s'", argument);
    return ARGP_ERR_UNKNOWN;
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_FORMAT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .parser = parse,
    .doc = "See whether everything that the program needs is installed and works, and say what to "
           "do about what does not."
           "\v"
           "Exit code: 0 when all that is needed is there (warnings: something is worse without), "
           "1 when something is missing.\n\n"
           "Example:\n"
           "  crashpulse doctor\n",
    .children = CHILDREN,
};

cp_status cmd_doctor(int argc, char **argv, cp_error *error)
{
    static const char *const COLUMN[] = {"what", "state", "found", "to_do"};
    cp_format format = CP_FORMAT_TABLE;
    cp_args_parse(&ARGP, argc, argv, &format);
    examination x = {0};
    cp_table_begin(&x.table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    look_at_programs(&x);
    look_at_worker(&x);
    look_at_parts(&x);
    look_at_crash(&x);
    look_at_system(&x);
    cp_status status = cp_table_print(&x.table, format, stdout, error);
    cp_table_destroy(&x.table);
    if (status == CP_OK && x.is_ill)
        status = cp_fail(error, CP_RUN_FAILED, "something that is needed is missing");
    return status;
}
