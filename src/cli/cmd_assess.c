/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assess/assessment_store.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "core/log.h"
#include "core/units.h"
#include "crash/validity.h"

#include <math.h>
#include <string.h>

#define TYPES_MAX 256
#define FILES_MAX 16

typedef struct arguments {
    cp_assessment_request request;
    const char *routes_path[FILES_MAX];
    const char *type[TYPES_MAX];
    cp_format format;
} arguments;

enum {
    COLLISIONS = 'c',
    FCD = 257, /* -f is the format */
    CONFIGURATIONS = 'l',
    ROUTES = 'r',
    VEHICLE = 'v',
    TYPE = 'T',
    DB = 'd',
    NAME = 'n',
    STRICT = 256
};

static const struct argp_option OPTIONS[] = {
    {"collisions", COLLISIONS, "FILE", 0, "SUMO's --collision-output of a finished run", 0},
    {"fcd", FCD, "FILE", 0,
     "its --fcd-output; write it with --precision 6. Without it the places that SUMO 1.24 and "
     "later "
     "write with each collision (colliderFront, ...) are used",
     0},
    {"routes", ROUTES, "FILE", 0,
     "its route or additional file with vTypes: class, length and width of the vehicles; may be "
     "repeated",
     0},
    {"configurations", CONFIGURATIONS, "FILE", 0, "a list of crash configurations, CSV", 0},
    {"vehicle", VEHICLE, "VEHICLE", 0, "what cars not named by --type crash as", 0},
    {"type", TYPE, "TYPE=VEHICLE", 0, "what a SUMO vehicle type crashes as; may be repeated", 0},
    {"db", DB, "FILE", 0, "store crashes and pulses in this new database", 0},
    {"name", NAME, "NAME", 0, "name of the study in the database (default: assessment)", 0},
    {"strict", STRICT, NULL, 0,
     "end at the first row that cannot be assessed; without it such rows are named and left out, "
     "and "
     "the exit code is 2 when the others are done",
     0},
    {0},
};

static void add_to(struct argp_state *state, const char *list[], size_t *count, size_t room,
                   const char *argument)
{
    if (*count == room)
        argp_error(state, "at most %zu of '%s' and the like", room, argument);
    list[(*count)++] = argument;
}

static void check(struct argp_state *state, const arguments *a)
{
    if ((a->request.collisions_path != NULL) == (a->request.configurations_path != NULL))
        argp_error(state, "either --collisions, or --configurations");
    if (a->request.configurations_path != NULL && a->request.fcd_path != NULL)
        argp_error(state, "--fcd belongs to --collisions");
    if (a->request.configurations_path != NULL && a->request.routes_count > 0)
        argp_error(state, "--routes belongs to --collisions");
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        return 0;
    case COLLISIONS:
        a->request.collisions_path = argument;
        return 0;
    case FCD:
        a->request.fcd_path = argument;
        return 0;
    case ROUTES:
        add_to(state, a->routes_path, &a->request.routes_count, FILES_MAX, argument);
        return 0;
    case CONFIGURATIONS:
        a->request.configurations_path = argument;
        return 0;
    case VEHICLE:
        a->request.vehicle = argument;
        return 0;
    case TYPE:
        if (strchr(argument, '=') == NULL || argument[0] == '=')
            argp_error(state, "--type must be TYPE=VEHICLE, found '%s'", argument);
        add_to(state, a->type, &a->request.type_count, TYPES_MAX, argument);
        return 0;
    case DB:
        a->request.db_path = argument;
        return 0;
    case NAME:
        a->request.name = argument;
        return 0;
    case STRICT:
        a->request.strict = true;
        return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "no such argument: '%s'", argument);
        return 0;
    case ARGP_KEY_END:
        check(state, a);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_FORMAT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "",
    .doc =
        "Put ready collisions through the path that those of a study take: poses, contact "
        "configuration, surrogate with both vehicle models, OLC and the other severities. No "
        "traffic is simulated."
        "\v"
        "Collisions of a SUMO run: the first contact is found between the steps of the record; "
        "where SUMO took the vehicles away before (collision.action teleport, its default "
        "minGap factor) they are carried on by their last motion; where one turned "
        "and steps are longer than 0.25 s how they met is not known, and told. Without --fcd their "
        "ways before the first "
        "report are at the speeds of then, turning as from the first report to the next if there "
        "is one: coarser in turns. Contacts that a study would "
        "not count are listed with their reason. time_s is SUMO's clock at the end of a step, as "
        "in a study; the files name a step by its beginning.\n\n"
        "A list of configurations has a first line of column names:\n"
        "  speed_a_km_h,speed_b_km_h,offset_mm,angle_deg, as of 'crash'; or poses\n"
        "  x_a_m,y_a_m,heading_a_deg,speed_a_km_h and the same of b, before contact,\n"
        "  with yaw_rate_a_deg_s,yaw_rate_b_deg_s if they turn; and in both kinds\n"
        "  id,vehicle_a,vehicle_b if there are names and vehicles.\n\n"
        "A vehicle is the name of a shipped one or a file. Without --type and --vehicle a type is "
        "what "
        "its vType in the --routes says, by class and size.\n\n"
        "Examples:\n"
        "  crashpulse assess --collisions coll.xml --fcd fcd.xml --routes r.rou.xml \\\n"
        "      --type van=my_van.yaml --db crashes.db\n"
        "  crashpulse assess --configurations cases.csv --vehicle mid_size --format csv\n",
    .children = CHILDREN,
};

// ---- output --------------------------------------------------------------------------------

static const char *const COLUMN[] = {"crash",
                                     "time_s",
                                     "a",
                                     "b",
                                     "model_a",
                                     "model_b",
                                     "crash_type",
                                     "closing_speed_km_h",
                                     "offset_mm",
                                     "angle_deg",
                                     "overlap_1",
                                     "side_a",
                                     "side_b",
                                     "speed_a_km_h",
                                     "speed_b_km_h",
                                     "delta_v_a_km_h",
                                     "delta_v_b_km_h",
                                     "olc_a_g",
                                     "olc_b_g",
                                     "olc_status_a",
                                     "olc_status_b",
                                     "validity_a",
                                     "validity_b"};

static void add_row(cp_table *table, size_t number, const cp_crash_row *crash)
{
    const cp_crash_vehicle_row *v = crash->vehicle;
    const cp_crash_description *description = &crash->description;
    char text[CP_VALIDITY_TEXT_SIZE];
    cp_table_integer(table, (int64_t)number);
    cp_table_real(table, crash->time_s);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, v[role].sumo_id);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, v[role].vehicle_model);
    cp_table_text(table, cp_crash_type_text(v[0].side, v[1].side));
    cp_table_real(table, cp_km_h_from_m_s(description->closing_speed_m_s));
    cp_table_real(table, 1000.0 * description->lateral_offset_m);
    cp_table_real(table, cp_deg_from_rad(description->angle_rad));
    cp_table_real(table, description->overlap_1);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, cp_contact_side_text(v[role].side));
    for (int role = 0; role < 2; role++)
        cp_table_real(table, cp_km_h_from_m_s(v[role].speed_m_s));
    for (int role = 0; role < 2; role++)
        cp_table_real(table, cp_km_h_from_m_s(v[role].severity.delta_v_m_s));
    for (int role = 0; role < 2; role++)
        cp_table_real(
            table, v[role].severity.olc.status == CP_OLC_VALUE ? v[role].severity.olc.olc_g : NAN);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, cp_olc_status_text(v[role].severity.olc.status));
    for (int role = 0; role < 2; role++)
        cp_table_text(table, cp_validity_text(v[role].outside, text));
}

static cp_status print(const cp_assessment *assessment, cp_format format, cp_error *error)
{
    cp_table table = {0};
    cp_table_begin(&table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    for (size_t k = 0; k < assessment->results.crash_count; k++)
        add_row(&table, k, &assessment->results.crash[k]);
    cp_status status = cp_table_print(&table, format, stdout, error);
    cp_table_destroy(&table);
    const cp_assessment_count *count = &assessment->count;
    cp_log_info("%zu listed: %zu crashes (%zu of them beyond the record), %zu not counted, %zu do "
                "not touch, of %zu it is not known, %zu left out",
                count->listed, count->crashes, count->carried, count->filtered, count->no_contact,
                count->unknown, count->bad);
    return status;
}

cp_status cmd_assess(int argc, char **argv, cp_error *error)
{
    arguments a = {.request.name = "assessment"};
    cp_assessment assessment;
    a.request.routes_path = a.routes_path;
    a.request.type = a.type;
    cp_args_parse(&ARGP, argc, argv, &a);
    cp_status status = cp_assessment_make(&a.request, &assessment, error);
    if (status == CP_OK && a.request.db_path != NULL)
        status = cp_assessment_store(&assessment, error);
    if (status == CP_OK)
        status = print(&assessment, a.format, error);
    if (status == CP_OK && assessment.count.bad > 0)
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: %zu of %zu rows could not be assessed (named above); the others are "
                         "done",
                         a.request.collisions_path != NULL ? a.request.collisions_path
                                                           : a.request.configurations_path,
                         assessment.count.bad, assessment.count.listed);
    cp_assessment_destroy(&assessment);
    return status;
}
