/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/pair.h"

#include "run/branch_answer.h"
#include "run/counterfactual.h"
#include "run/crash_record.h"
#include "run/run_road.h"

#include "builders/crash_library.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

/* Crashes of a scripted road and their branches, in real processes but without SUMO: a car at
 * 20 m/s comes upon one that stands. */

#define PI 3.14159265358979323846
#define FOLLOWER_M_S 20.0
#define GAP_M 201.0 /* met at 0.1 s + 10.05 s */

typedef struct world {
    cp_study_vehicle vehicle;
    cp_study study; /* names no vehicles: everybody is the fleet's car */
    cp_vehicle_model model;
    cp_fleet fleet;
    cp_control_settings aeb;
    cp_treatment treatment[2];
    cp_treatments treatments;
    cp_simulation simulation;
    cp_counterfactual *counterfactual;
    cp_result_rows results;
    cp_counterfactual_rows rows;
} world;

// "nothing" and an AEB that sees all round.
static void prepare(world *w)
{
    static const char *const NAMES[] = {"ttc_s", "deceleration_m_s2", "required_deceleration_m_s2",
                                        NULL};
    static const double VALUES[] = {2.0, 8.0, 0.0};
    *w = (world){.model = cp_vehicle_model_default()};
    strcpy(w->model.name, "car");
    w->study = (cp_study){.vehicles = &w->vehicle, .vehicle_count = 1};
    w->fleet = (cp_fleet){.study = &w->study, .models = &w->model, .count = 1};
    w->aeb = road_settings(CP_CONTROL_FUNCTION, "aeb", NAMES, VALUES);
    w->treatment[0] = (cp_treatment){.name = "nothing"};
    w->treatment[1] = (cp_treatment){"aeb", &w->aeb, 1};
    w->treatments = (cp_treatments){.baseline = "baseline",
                                    .treatment = w->treatment,
                                    .count = 2,
                                    .timing = {.checkpoint_interval_s = 2.0,
                                               .checkpoints = 20,
                                               .time_series_s = 1.0,
                                               .horizon_s = 5.0},
                                    .study_seed = 1,
                                    .seed = 2};
}

static void begin(world *w)
{
    cp_error error = {0};
    const cp_simulation_settings settings = {.step_length_s = ROAD_STEP_S, .is_treated = true};
    run_road_begin(&settings, &w->simulation);
    if (cp_counterfactual_create(&w->treatments, &w->simulation, &w->counterfactual, &error) !=
        CP_OK)
        fail_msg("%s", error.text);
}

static void run_until(world *w, double time_s)
{
    cp_error error = {0};
    while (cp_traffic_time_s(w->simulation.traffic) < time_s - 1e-9) {
        cp_status status = cp_simulation_step(&w->simulation, &error);
        if (status == CP_OK)
            status = cp_counterfactual_step(w->counterfactual, &error);
        if (status != CP_OK)
            fail_msg("%s", error.text);
    }
}

// The stored crash of a found contact.
static cp_crash_row *record(world *w, const cp_found_contact *found)
{
    cp_error error = {0};
    cp_impact_names names = {.sumocfg_path = "a.sumocfg"};
    for (int role = 0; role < 2; role++) {
        names.sumo_id[role] =
            cp_traffic_vehicle_id(w->simulation.traffic, found->impact.vehicle[role]);
        names.sumo_type[role] =
            cp_traffic_type_id(w->simulation.traffic, found->impact.state[role].type);
        names.lane[role] =
            cp_traffic_lane_id(w->simulation.traffic, found->impact.state[role].lane);
        assert_int_equal(cp_traffic_type(w->simulation.traffic, names.sumo_type[role],
                                         &names.type[role], &error),
                         CP_OK);
    }
    cp_crash_row *row = cp_result_rows_add_crash(&w->results);
    assert_non_null(row);
    if (cp_crash_record_fill(&found->impact, &names, &w->fleet, CP_RECORD_ALL, row, &error) !=
        CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(
        cp_participant_rows_copy(&found->participants, false, &row->participants, &error), CP_OK);
    return row;
}

static void conclude(world *w)
{
    cp_error error = {0};
    for (size_t k = 0; k < w->simulation.found_count; k++)
        if (w->simulation.found[k].found_as == CP_FOUND_CRASH)
            record(w, &w->simulation.found[k]);
    if (cp_counterfactual_conclude(w->counterfactual, &w->fleet, w->results.crash,
                                   w->results.crash_count, &w->rows, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static void end(world *w)
{
    cp_counterfactual_rows_destroy(&w->rows);
    cp_result_rows_destroy(&w->results);
    cp_counterfactual_destroy(w->counterfactual);
    cp_simulation_end(&w->simulation);
}

static void add_follower_and_standing(void)
{
    road_add("follower", 0.0, 0.0, 0.0, FOLLOWER_M_S);
    road_add("standing", GAP_M + 4.5, 0.0, 0.0, 0.0);
}

static void a_pair_is_reproduced_and_a_function_helps(void **state)
{
    (void)state;
    world w;
    prepare(&w);
    begin(&w);
    add_follower_and_standing();
    run_until(&w, 12.0);
    conclude(&w);

    assert_int_equal(w.rows.null_treatment_count, 1);
    const cp_null_treatment_row *null = &w.rows.null_treatment[0];
    assert_int_equal(null->status, CP_NULL_REPRODUCED);
    assert_string_equal(null->detail, "");
    assert_string_equal(null->variant, "baseline");
    // No driver erred: 4 s before contact, and checkpoints are taken every 2 s from 0.1 s on.
    assert_true(fabs(null->lead_s - 4.0) < 1e-9);
    assert_true(fabs(null->checkpoint_s - 6.1) < 1e-6);

    assert_int_equal(w.rows.row_count, 2);
    const cp_counterfactual_row *nothing = &w.rows.row[0], *aeb = &w.rows.row[1];
    assert_string_equal(nothing->variant, "nothing");
    assert_int_equal(nothing->outcome, CP_OUTCOME_UNCHANGED);
    assert_true(nothing->has_crash);
    assert_true(nothing->treated.time_s == w.results.crash[0].time_s);
    assert_true(nothing->treated.description.closing_speed_m_s ==
                w.results.crash[0].description.closing_speed_m_s);
    assert_string_equal(aeb->variant, "aeb");
    // 40 m are enough to stop from 20 m/s at 8 m/s^2.
    assert_int_equal(aeb->outcome, CP_OUTCOME_AVOIDED);
    assert_false(aeb->has_crash);
    assert_int_equal(aeb->new_crashes + aeb->vanished_crashes, 0);

    // Both cars within a second of contact, until the crash.
    assert_int_equal(nothing->sample_count, 20);
    for (size_t k = 0; k < nothing->sample_count; k++) {
        const cp_sample_row *sample = &nothing->sample[k];
        assert_true(fabs(sample->time_s - 10.15) <= 1.0 + 1e-9);
        double way_m = GAP_M - FOLLOWER_M_S * (sample->time_s - 0.1);
        if (sample->role == 0 && way_m > 0.0)
            assert_true(fabs(sample->ttc_s - way_m / FOLLOWER_M_S) < 1e-6);
    }
    end(&w);
}

// A treated branch that fails says why; the others are what they are.
static void why_a_branch_fails_is_told(void **state)
{
    (void)state;
    world w;
    prepare(&w);
    begin(&w);
    add_follower_and_standing();
    run_road.fails_on_command = true;
    run_until(&w, 12.0);
    conclude(&w);
    assert_int_equal(w.rows.null_treatment[0].status, CP_NULL_REPRODUCED);
    assert_int_equal(w.rows.row[0].outcome, CP_OUTCOME_UNCHANGED);
    assert_int_equal(w.rows.row[1].outcome, CP_OUTCOME_INVALID);
    assert_int_equal(w.rows.row[1].reason, CP_NULL_BRANCH_FAILED);
    assert_string_equal(w.rows.row[1].detail, "failed: no commands for 'follower'");
    end(&w);
}

static void pairs_without_a_checkpoint_say_so(void **state)
{
    (void)state;
    world w;
    prepare(&w);
    w.treatments.timing.checkpoints = 1;
    begin(&w);
    add_follower_and_standing();
    // The only checkpoint kept is always less than 4 s old.
    run_until(&w, 10.2);
    // Two cars that meet 3 s after they came.
    road_add("east", 0.0, 100.0, 0.0, 10.0);
    road_add("west", 60.0, 100.0, PI, 10.0);
    run_until(&w, 15.0);
    conclude(&w);
    assert_int_equal(w.rows.null_treatment_count, 2);
    assert_int_equal(w.rows.null_treatment[0].status, CP_NULL_NO_CHECKPOINT);
    assert_int_equal(w.rows.null_treatment[1].status, CP_NULL_INSERTED_LATE);
    assert_true(isnan(w.rows.null_treatment[0].checkpoint_s));
    for (size_t k = 0; k < 4; k++) {
        assert_int_equal(w.rows.row[k].outcome, CP_OUTCOME_INVALID);
        assert_int_equal(w.rows.row[k].reason, w.rows.null_treatment[k / 2].status);
        assert_false(w.rows.row[k].has_crash);
    }
    end(&w);
}

// Who brakes is hit from behind: another opponent.
static void another_opponent_is_told(void **state)
{
    (void)state;
    world w;
    prepare(&w);
    begin(&w);
    add_follower_and_standing();
    road_add("close", -8.0, 0.0, 0.0, FOLLOWER_M_S);
    run_until(&w, 10.3);
    // In the baseline the two are gone and the third drives on.
    assert_int_equal(w.simulation.found_count, 1);
    run_until(&w, 12.0);
    assert_int_equal(w.simulation.found_count, 1);
    conclude(&w);
    const cp_counterfactual_row *aeb = &w.rows.row[1];
    assert_int_equal(aeb->outcome, CP_OUTCOME_CHANGED_OPPONENT);
    // The baseline's role a stays a, now struck from behind.
    const cp_crash_vehicle_row *vehicle = aeb->treated.vehicle;
    assert_string_equal(vehicle[0].sumo_id, "follower");
    assert_string_equal(vehicle[1].sumo_id, "close");
    assert_int_equal(vehicle[0].side, CP_SIDE_REAR);
    assert_int_equal(vehicle[1].side, CP_SIDE_FRONT);
    assert_int_equal(vehicle[0].severity.olc.status, CP_OLC_NOT_FRONT_CONTACT);
    assert_int_equal(vehicle[1].severity.olc.status, CP_OLC_VALUE);
    end(&w);
}

// ---- answers made by hand ------------------------------------------------------------------

typedef struct answer_bytes {
    _Alignas(64) char bytes[65536];
    size_t size;
} answer_bytes;

static void send_by_pipe(const world *w, const cp_found_contact *found, answer_bytes *to)
{
    int ends[2];
    cp_error error = {0};
    assert_int_equal(pipe(ends), 0);
    if (cp_branch_answer_send(ends[1], w->simulation.traffic, found, NULL, 0, NULL, 0, &error) !=
        CP_OK)
        fail_msg("%s", error.text);
    close(ends[1]);
    ssize_t got;
    to->size = 0;
    while ((got = read(ends[0], to->bytes + to->size, sizeof to->bytes - to->size)) > 0)
        to->size += (size_t)got;
    close(ends[0]);
}

// A head-on crash with everything of the two cars different.
static void crash_head_on(world *w)
{
    prepare(w);
    begin(w);
    road_add("east", 0.0, 0.0, 0.0, 10.0);
    road_add("west", 51.0, 0.4, PI, 14.0);
    run_until(w, 4.0);
    assert_int_equal(w->simulation.found_count, 1);
}

static void roles_swap_as_a_whole(void **state)
{
    (void)state;
    world w;
    answer_bytes bytes;
    cp_branch_answer answer, once;
    crash_head_on(&w);
    cp_found_contact *found = &w.simulation.found[0];
    found->impact.side[1] = CP_SIDE_LEFT;
    found->car[0] = (cp_found_car){true, true, false, 1.5};
    found->car[1] = (cp_found_car){false, false, true, 2.5};
    found->impact.state[1].lane = 1;
    send_by_pipe(&w, found, &bytes);
    assert_true(cp_branch_answer_read(bytes.bytes, bytes.size, &answer));
    once = answer;
    cp_branch_answer_swap_roles(&once);
    assert_true(once.is_swapped);
    for (int role = 0; role < 2; role++) {
        const cp_impact *is = &once.found.impact, *was = &answer.found.impact;
        assert_int_equal(is->vehicle[role], was->vehicle[1 - role]);
        assert_memory_equal(&is->state[role], &was->state[1 - role], sizeof is->state[role]);
        assert_true(is->yaw_rate_rad_s[role] == was->yaw_rate_rad_s[1 - role]);
        assert_true(is->front_velocity_m_s[role].x == was->front_velocity_m_s[1 - role].x);
        assert_true(is->front_velocity_m_s[role].y == was->front_velocity_m_s[1 - role].y);
        assert_int_equal(is->side[role], was->side[1 - role]);
        const cp_found_car *car = &once.found.car[role], *other = &answer.found.car[1 - role];
        assert_int_equal(car->at_fault, other->at_fault);
        assert_int_equal(car->errs_alone, other->errs_alone);
        assert_int_equal(car->had_crashed, other->had_crashed);
        assert_true(car->error_since_s == other->error_since_s);
        assert_string_equal(once.car[role].id, answer.car[1 - role].id);
        assert_string_equal(once.car[role].lane, answer.car[1 - role].lane);
    }
    assert_string_equal(once.car[0].id, "west");
    assert_string_equal(once.car[0].lane, ":corner_0_0");
    assert_int_equal(once.found.impact.side[0], CP_SIDE_LEFT);
    assert_true(once.found.car[0].error_since_s == 2.5 && once.found.car[1].error_since_s == 1.5);
    // What is of the crash and of neither car stays.
    assert_true(once.found.impact.time_s == answer.found.impact.time_s);
    cp_branch_answer_swap_roles(&once);
    assert_false(once.is_swapped);
    assert_memory_equal(&once.found.impact.state, &answer.found.impact.state,
                        sizeof answer.found.impact.state);
    end(&w);
}

// A treated crash whose roles the detector gave the other way round is told with the baseline's.
static void a_pair_keeps_the_roles_of_the_baseline(void **state)
{
    (void)state;
    world w;
    answer_bytes null_bytes, treated_bytes;
    cp_error error = {0};
    crash_head_on(&w);
    cp_found_contact *found = &w.simulation.found[0];
    cp_crash_row *crash = record(&w, found);
    const char *ids[2] = {crash->vehicle[0].sumo_id, crash->vehicle[1].sumo_id};
    send_by_pipe(&w, found, &null_bytes);

    // The same crash, 2 m/s slower for the second car, roles the other way round.
    cp_found_contact treated = *found;
    treated.impact.front_velocity_m_s[1].x += 2.0;
    treated.impact.state[1].speed_m_s -= 2.0;
    cp_impact_swap_roles(&treated.impact);
    treated.car[0] = found->car[1];
    treated.car[1] = found->car[0];
    send_by_pipe(&w, &treated, &treated_bytes);

    const cp_branch_end ends[3] = {{true, null_bytes.bytes, null_bytes.size, ""},
                                   {true, null_bytes.bytes, null_bytes.size, ""},
                                   {true, treated_bytes.bytes, treated_bytes.size, ""}};
    const cp_pair pair = {.treatments = &w.treatments,
                          .simulation = &w.simulation,
                          .fleet = &w.fleet,
                          .crash = crash,
                          .ids = {ids[0], ids[1]},
                          .status = CP_NULL_REPRODUCED,
                          .lead_s = 4.0,
                          .checkpoint_s = 0.1,
                          .ends = ends};
    if (cp_pair_conclude(&pair, &w.rows, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(w.rows.null_treatment[0].status, CP_NULL_REPRODUCED);
    const cp_counterfactual_row *row = &w.rows.row[1];
    assert_int_equal(row->outcome, CP_OUTCOME_MITIGATED);
    assert_string_equal(row->treated.vehicle[0].sumo_id, ids[0]);
    assert_string_equal(row->treated.vehicle[1].sumo_id, ids[1]);
    assert_true(fabs(row->treated.vehicle[0].speed_m_s - 10.0) < 1e-9);
    assert_true(fabs(row->treated.vehicle[1].speed_m_s - 12.0) < 1e-9);
    assert_true(fabs(row->treated.description.lateral_offset_m -
                     crash->description.lateral_offset_m) < 1e-9);
    // The same one as null treatment, roles changed: what differs is who.
    const cp_branch_end swapped[3] = {ends[2], ends[1], ends[2]};
    cp_pair other = pair;
    other.ends = swapped;
    if (cp_pair_conclude(&other, &w.rows, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(w.rows.null_treatment[1].status, CP_NULL_NOT_REPRODUCED);
    assert_string_equal(w.rows.null_treatment[1].detail, "crash of west and east");
    assert_int_equal(w.rows.row[3].outcome, CP_OUTCOME_INVALID);

    // Bytes that are no answer are an error, not an outcome.
    const cp_branch_end cut[3] = {
        {true, null_bytes.bytes, null_bytes.size - 1, ""}, ends[1], ends[2]};
    other.ends = cut;
    assert_int_equal(cp_pair_conclude(&other, &w.rows, &error), CP_RUN_FAILED);
    end(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pair_is_reproduced_and_a_function_helps),
        cmocka_unit_test(why_a_branch_fails_is_told),
        cmocka_unit_test(pairs_without_a_checkpoint_say_so),
        cmocka_unit_test(another_opponent_is_told),
        cmocka_unit_test(roles_swap_as_a_whole),
        cmocka_unit_test(a_pair_keeps_the_roles_of_the_baseline),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
