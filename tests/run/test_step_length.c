/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"
#include "core/units.h"
#include "impact/impact.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* The same crash of two cars on real SUMO at different step lengths, for every crash type of the
 * scenario library. Both keep their speed and pay no heed to each other, so that nothing but the
 * step length differs. */

typedef struct encounter {
    const char *scenario;
    const char *ego_edges, *foe_edges;
    double ego_position_m, foe_position_m; /* of departure */
    const char *ego_lane;
    double ego_speed_m_s, foe_speed_m_s;
    double steer_from_s; /* ego's way out of its lane (overlay) ... */
    double slope_1;      /* ... at this slope ... */
    double aside_m;      /* ... up to this offset; INFINITY: on and on */
} encounter;

static const encounter LEFT_TURN = {
    "left_turn", "west_in north_out", "east_in west_out", 330, 150, "1", 8, 20, 0, 0, 0};
static const encounter CROSSING = {
    "crossing", "south_1_in north_1_out", "west_in middle_east", 190, 195, "0", 8, 19, 0, 0, 0};
static const encounter DRIFT = {
    "head_on_drift", "eastbound", "westbound", 300, 5200, "0", 20, 24, 6.0, 0.03, INFINITY};
static const encounter OVERTAKING = {
    "head_on_overtaking", "eastbound", "westbound", 300, 5200, "0", 22, 20, 4.0, 0.06, 3.2};

/* From the other side; and one that drives into another. */
static const encounter CROSSING_RIGHT = {
    "crossing", "north_1_in south_1_out", "west_in middle_east", 190, 195, "0", 8, 19, 0, 0, 0};
static const encounter REAR_END = {
    "head_on_drift", "eastbound", "eastbound", 300, 560, "0", 30, 4, 0, 0, 0};

/* What is compared. */
typedef struct outcome {
    bool crashed;
    double time_s, closing_speed_m_s, lateral_offset_m, angle_rad, ego_speed_m_s;
    const char *type;
} outcome;

static void write_routes(const encounter *meeting, char path[64])
{
    snprintf(path, 64, "/tmp/crashpulse-routes-XXXXXX");
    int file = mkstemp(path);
    assert_true(file >= 0);
    FILE *stream = fdopen(file, "w");
    assert_non_null(stream);
    fprintf(stream,
            "<routes><vType id=\"car\" length=\"4.5\" width=\"1.8\" sigma=\"0\" speedDev=\"0\" "
            "maxSpeed=\"60\"/>\n"
            "<vehicle id=\"ego\" type=\"car\" depart=\"0\" departPos=\"%g\" departLane=\"%s\">"
            "<route edges=\"%s\"/></vehicle>\n"
            "<vehicle id=\"foe\" type=\"car\" depart=\"0\" departPos=\"%g\">"
            "<route edges=\"%s\"/></vehicle></routes>\n",
            meeting->ego_position_m, meeting->ego_lane, meeting->ego_edges, meeting->foe_position_m,
            meeting->foe_edges);
    assert_int_equal(fclose(stream), 0);
}

static void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s", error->text);
}

// Whoever has come drives at his speed from now on and heeds nobody.
static void send_off(const cp_traffic *traffic, const encounter *meeting)
{
    const cp_traffic_source *commands = cp_traffic_commands(traffic);
    cp_error error = {0};
    size_t count;
    const uint32_t *departed = cp_traffic_departed(traffic, &count);
    for (size_t k = 0; k < count; k++) {
        bool is_ego = strcmp(cp_traffic_vehicle_id(traffic, departed[k]), "ego") == 0;
        assert_ok(commands->set_parameter(departed[k], "junctionModel.ignoreIDs",
                                          is_ego ? "foe" : "ego", &error),
                  &error);
        assert_ok(commands->set_speed_mode(departed[k], 0, &error), &error);
        assert_ok(commands->set_speed(departed[k],
                                      is_ego ? meeting->ego_speed_m_s : meeting->foe_speed_m_s,
                                      &error),
                  &error);
    }
}

// Out of the lane at a slope, up to an offset.
static void steer(const cp_traffic *traffic, const encounter *meeting, uint32_t ego)
{
    cp_lateral_overlays *overlays = cp_traffic_overlays(traffic);
    double left_s =
        cp_traffic_time_s(traffic) + cp_traffic_step_length_s(traffic) - meeting->steer_from_s;
    if (meeting->slope_1 == 0.0 || left_s <= 1e-9)
        return;
    double way_m = meeting->ego_speed_m_s * cp_traffic_step_length_s(traffic);
    double left_m = meeting->aside_m - cp_lateral_overlay_get(overlays, ego).offset_m;
    double mean_1 = fmin(meeting->slope_1, left_m / way_m);
    cp_error error = {0};
    assert_ok(cp_lateral_overlay_steer(overlays, ego, mean_1,
                                       left_m > meeting->slope_1 * way_m ? meeting->slope_1 : 0.0,
                                       &error),
              &error);
}

static outcome describe(const cp_traffic *traffic, const cp_impact *impact)
{
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_crash_description description = cp_impact_describe(impact, &model, &model);
    int ego = strcmp(cp_traffic_vehicle_id(traffic, impact->vehicle[0]), "ego") == 0 ? 0 : 1;
    return (outcome){impact->verdict == CP_CONTACT_CONFIRMED,
                     impact->time_s,
                     description.closing_speed_m_s,
                     description.lateral_offset_m,
                     description.angle_rad,
                     impact->state[ego].speed_m_s,
                     cp_crash_type_text(impact->side[0], impact->side[1])};
}

static outcome crash(const encounter *meeting, double step_length_s,
                     const cp_control_settings *function)
{
    char configuration[1024], routes[64];
    snprintf(configuration, sizeof configuration, "%s/sumo_scenarios/%s/%s.sumocfg",
             getenv("CRASHPULSE_BUILD"), meeting->scenario, meeting->scenario);
    write_routes(meeting, routes);
    const char *options[] = {"--route-files", routes};
    cp_traffic_options traffic_options = {.sumocfg = configuration,
                                          .seed = 1,
                                          .step_length_s = step_length_s,
                                          .options = options,
                                          .option_count = 2};
    cp_traffic *traffic;
    cp_controls *controls;
    cp_detector *detector;
    cp_error error = {0};
    outcome found = {0};
    assert_ok(cp_traffic_create(&traffic_options, &traffic, &error), &error);
    assert_ok(cp_controls_create(function, function != NULL, 1, 1, traffic, &controls, &error),
              &error);
    assert_ok(cp_detector_create(&detector, &error), &error);
    while (!found.crashed && cp_traffic_time_s(traffic) < 200.0 &&
           (cp_traffic_time_s(traffic) < 1.0 || !cp_traffic_finished(traffic))) {
        assert_ok(cp_traffic_step(traffic, &error), &error);
        send_off(traffic, meeting);
        steer(traffic, meeting, 0);
        assert_ok(cp_controls_step(controls, &error), &error);
        const cp_impact *impacts;
        size_t count;
        assert_ok(cp_detector_step(detector, traffic, NULL, NULL, &impacts, &count, &error),
                  &error);
        if (count > 0)
            found = describe(traffic, &impacts[0]);
    }
    cp_detector_destroy(detector);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    unlink(routes);
    printf("%-20s dt %.2f: t %.3f s, %s, closing %.3f m/s, offset %.3f m, angle %.2f deg, ego "
           "%.2f m/s\n",
           meeting->scenario, step_length_s, found.time_s, found.type ? found.type : "none",
           found.closing_speed_m_s, found.lateral_offset_m, cp_deg_from_rad(found.angle_rad),
           found.ego_speed_m_s);
    return found;
}

static void assert_same_crash(const encounter *meeting, const char *type, double step_length_s,
                              const cp_control_settings *function, double speed_m_s)
{
    outcome fine = crash(meeting, 0.01, function), coarse = crash(meeting, step_length_s, function);
    assert_true(fine.crashed && coarse.crashed);
    assert_string_equal(fine.type, type);
    assert_string_equal(coarse.type, type);
    assert_true(fabs(coarse.closing_speed_m_s - fine.closing_speed_m_s) <= speed_m_s);
    if (function != NULL)
        return;
    assert_true(fabs(coarse.lateral_offset_m - fine.lateral_offset_m) <= 0.1);
    assert_true(fabs(coarse.angle_rad - fine.angle_rad) <= cp_rad_from_deg(2.0));
}

static void a_left_turn_is_the_same_at_every_step(void **state)
{
    (void)state;
    assert_same_crash(&LEFT_TURN, "front-front", 0.1, NULL, 0.1);
    assert_same_crash(&LEFT_TURN, "front-front", 0.05, NULL, 0.1);
}

static void a_crossing_is_the_same_at_every_step(void **state)
{
    (void)state;
    assert_same_crash(&CROSSING, "front-side", 0.1, NULL, 0.1);
}

// The other comes sooner or later: front on front, into the one or the other side.
static void assert_same_crashes(encounter meeting, double from_m, double to_m, const char *type)
{
    bool is_type_seen = false;
    for (meeting.foe_position_m = from_m; meeting.foe_position_m <= to_m;
         meeting.foe_position_m += 3.1) {
        const char *found = crash(&meeting, 0.01, NULL).type;
        assert_non_null(found);
        assert_same_crash(&meeting, found, 0.1, NULL, 0.1);
        is_type_seen |= strcmp(found, type) == 0;
    }
    assert_true(is_type_seen);
}

// (A turning car of SUMO goes round in a few kinks, at each of which its yaw rate jumps: what falls
// into the step of such a jump differs by up to the jump, so those are not asked for here.)
static void crashes_at_junctions_are_the_same_wherever_they_strike(void **state)
{
    (void)state;
    assert_same_crashes(LEFT_TURN, 137.4, 141.0, "front-side");
    assert_same_crashes(LEFT_TURN, 143.2, 155.0, "front-front");
    assert_same_crashes(CROSSING, 184.0, 200.0, "front-side");
    assert_same_crashes(CROSSING_RIGHT, 175.0, 189.0, "front-side");
}

static void a_rear_end_is_the_same_at_every_step(void **state)
{
    (void)state;
    assert_same_crash(&REAR_END, "front-rear", 0.1, NULL, 0.1);
}

static void a_drift_is_the_same_at_every_step(void **state)
{
    (void)state;
    assert_same_crash(&DRIFT, "front-front", 0.1, NULL, 0.1);
}

static void an_overtaking_is_the_same_at_every_step(void **state)
{
    (void)state;
    assert_same_crash(&OVERTAKING, "front-front", 0.1, NULL, 0.1);
}

// Steps in which the two pass each other by 20 m and more, on the same road all the time.
static void no_head_on_is_jumped_over(void **state)
{
    (void)state;
    static const double STEPS_S[] = {0.25, 0.5, 1.0};
    for (encounter meeting = OVERTAKING; meeting.foe_position_m < 5240.0;
         meeting.foe_position_m += 5.3)
        for (size_t k = 0; k < sizeof STEPS_S / sizeof *STEPS_S; k++) {
            outcome found = crash(&meeting, STEPS_S[k], NULL);
            assert_true(found.crashed);
            assert_string_equal(found.type, "front-front");
        }
}

static void braked_crashes_are_the_same_to_0_3_m_s(void **state)
{
    (void)state;
    cp_control_settings aeb =
        cp_control_settings_default(cp_control_type_find(CP_CONTROL_FUNCTION, "aeb"));
    // On its route the left-turner sees the other coming before it turns: by default in time. With
    // less foresight a crash remains.
    cp_control_settings late = aeb;
    for (size_t k = 0; k < late.type->parameter_count; k++)
        if (strcmp(late.type->parameters[k].name, "ttc_s") == 0)
            late.parameter[k] = 0.6;
    assert_same_crash(&LEFT_TURN, "front-front", 0.05, &late, 0.3);
    assert_same_crash(&CROSSING, "front-side", 0.05, &aeb, 0.3);
    assert_same_crash(&REAR_END, "front-rear", 0.05, &aeb, 0.3);
    assert_same_crash(&DRIFT, "front-front", 0.05, &aeb, 0.3);
    assert_same_crash(&OVERTAKING, "front-front", 0.05, &aeb, 0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_left_turn_is_the_same_at_every_step),
        cmocka_unit_test(a_crossing_is_the_same_at_every_step),
        cmocka_unit_test(crashes_at_junctions_are_the_same_wherever_they_strike),
        cmocka_unit_test(a_rear_end_is_the_same_at_every_step),
        cmocka_unit_test(a_drift_is_the_same_at_every_step),
        cmocka_unit_test(an_overtaking_is_the_same_at_every_step),
        cmocka_unit_test(no_head_on_is_jumped_over),
        cmocka_unit_test(braked_crashes_are_the_same_to_0_3_m_s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
