/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/detector.h"

#include "builders/two_cars.h"
#include "core/units.h"
#include "impact/footprint.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* Every type of crash between two cars whose motion is known exactly, driven by SUMO: at 0.1 s as
 * at 0.01 s a step, braked as in closed form, and no touch at walking pace lost between two steps.
 * The same motion without SUMO beside it, at steps of a millisecond, says what is right. */

#define CLOSING_M_S 0.1 /* without braking, step length 0.1 s against 0.01 s */
#define OFFSET_M 0.1
#define ANGLE_DEG 2.0
#define BRAKED_M_S 0.3 /* braking before impact, step length 0.05 s against the closed form */
#define DECELERATION_M_S2 8.0
#define EXACT_STEP_S 0.001
#define END_S 12.0

/* A meeting of two cars, and what it has to be taken for. */
typedef struct meeting {
    const char *name, *type;
    bool own_is_a;
    two_cars cars;
} meeting;

#define STRAIGHT 0.0, 0.0, 0.0
#define ACROSS 9.0, CP_PI / 2.0, 0.0 /* left turn */
#define IN 8.0, -CP_PI / 2.0, 0.0    /* right turn out of a side road */

static const meeting UNBRAKED[] = {
    {"rear end", "front-rear", true, {"ahead", 20, 30, 0.4, 0, 12, STRAIGHT, 0}},
    {"struck from behind", "front-rear", false, {"behind", 10, -20, -0.5, 0, 18, STRAIGHT, 0}},
    {"head-on", "front-front", true, {"oncoming", 14, 61.3, 0, CP_PI, 15, STRAIGHT, 0}},
    {"head-on, half",
     "front-front",
     true,
     {"oncoming_half", 20, 97.7, 0.9, CP_PI, 15, STRAIGHT, 0}},
    {"head-on, a sixth",
     "front-front",
     true,
     {"oncoming_thin", 20, 97.7, 1.5, CP_PI, 15, STRAIGHT, 0}},
    {"into one from the right",
     "front-side",
     true,
     {"crossing", 15, 48.2, -2, CP_PI / 2, 8, STRAIGHT, -20}},
    {"struck from the right",
     "front-side",
     false,
     {"crossing", 15, 48.2, -2, CP_PI / 2, 8, STRAIGHT, -25.6}},
    {"into one from the left",
     "front-side",
     true,
     {"crossing_left", 15, 48.2, 2, -CP_PI / 2, 8, STRAIGHT, -20}},
    {"struck from the left",
     "front-side",
     false,
     {"crossing_left", 15, 48.2, 2, -CP_PI / 2, 8, STRAIGHT, -25.6}},
    {"into one obliquely",
     "front-side",
     true,
     {"crossing_oblique", 12, 38.9, 2.5, -CP_PI / 3, 8, STRAIGHT, -20}},
    {"left turn, fronts",
     "front-front",
     true,
     {"turning_across", 12, 52.4, 3.4, CP_PI, 6, ACROSS, -17}},
    {"left turn, into its side",
     "front-side",
     true,
     {"turning_across", 12, 52.4, 3.4, CP_PI, 6, ACROSS, -10.5}},
    {"left turn, into ours",
     "front-side",
     false,
     {"turning_across", 12, 52.4, 3.4, CP_PI, 6, ACROSS, -19}},
    {"turning in", "front-side", true, {"turning_in", 13, 42.3, -9, CP_PI / 2, 5, IN, -6}},
};
#define UNBRAKED_COUNT (sizeof UNBRAKED / sizeof *UNBRAKED)

/* The own car brakes; the other stands or is slow. */
static const meeting BRAKED[] = {
    {"standing ahead", "front-rear", true, {"ahead", 15, 30, 0.4, 0, 0, STRAIGHT, 0}},
    {"slower ahead", "front-rear", true, {"ahead", 20, 30, 0.4, 0, 5, STRAIGHT, 0}},
    {"standing oncoming",
     "front-front",
     true,
     {"oncoming_half", 20, 97.7, 0.9, CP_PI, 0, STRAIGHT, 0}},
    {"oncoming", "front-front", true, {"oncoming", 14, 61.3, 0, CP_PI, 6, STRAIGHT, 0}},
    {"standing across, from the right",
     "front-side",
     true,
     {"crossing", 15, 48.2, -2, CP_PI / 2, 0, STRAIGHT, 4}},
    {"from the right",
     "front-side",
     true,
     {"crossing", 15, 48.2, -2, CP_PI / 2, 1.2, STRAIGHT, -1}},
    {"standing across, from the left",
     "front-side",
     true,
     {"crossing_left", 15, 48.2, 2, -CP_PI / 2, 0, STRAIGHT, 4}},
    {"from the left",
     "front-side",
     true,
     {"crossing_left", 15, 48.2, 2, -CP_PI / 2, 1.2, STRAIGHT, -1}},
    {"standing obliquely",
     "front-side",
     true,
     {"crossing_oblique", 12, 38.9, 2.5, -CP_PI / 3, 0, STRAIGHT, 5}},
    {"obliquely", NULL, true, {"crossing_oblique", 12, 38.9, 2.5, -CP_PI / 3, 1, STRAIGHT, 0}},
    {"standing in its left turn",
     "front-side",
     true,
     {"turning_across", 12, 52.4, 3.4, CP_PI, 0, ACROSS, 10}},
    {"left turn", NULL, true, {"turning_across", 12, 52.4, 3.4, CP_PI, 2, ACROSS, 0}},
    {"standing as it turns in",
     "front-side",
     true,
     {"turning_in", 13, 42.3, -9, CP_PI / 2, 0, IN, 11.5}},
};
#define BRAKED_COUNT (sizeof BRAKED / sizeof *BRAKED)

/* One that is faster than an own car of 1 m/s and grazes it in passing: no touch of the latter's.
 */
static const meeting TURNING_IN = {
    "turning in", NULL, true, {"turning_in", 13, 42.3, -9, CP_PI / 2, 3, IN, 0}};

// ---- exact motion --------------------------------------------------------------------------

// The own car drives on until brake_s (INFINITY: for ever), then brakes at 8 m/s^2 to rest.
static double own_speed_m_s(const two_cars *e, double brake_s, double time_s)
{
    return fmax(0.0, e->own_m_s - DECELERATION_M_S2 * fmax(0.0, time_s - brake_s));
}

static double own_way_m(const two_cars *e, double brake_s, double time_s)
{
    double braked_s = fmin(fmax(0.0, time_s - brake_s), e->own_m_s / DECELERATION_M_S2);
    return e->own_m_s * (fmin(time_s, brake_s) + braked_s) -
           0.5 * DECELERATION_M_S2 * braked_s * braked_s;
}

static cp_vehicle_state exact_state(const two_cars *e, double brake_s, uint32_t vehicle,
                                    double time_s)
{
    cp_vehicle_state state = {
        .vehicle = vehicle, .length_m = TWO_CARS_LENGTH_M, .width_m = TWO_CARS_WIDTH_M};
    if (vehicle == 0) {
        state.front_x_m = own_way_m(e, brake_s, time_s);
        state.speed_m_s = own_speed_m_s(e, brake_s, time_s);
        return state;
    }
    cp_rectangle there = two_cars_target_at(e, time_s);
    cp_vec2 half_m = cp_vec2_scale(cp_vec2_heading(there.yaw_rad), 0.5 * TWO_CARS_LENGTH_M);
    state.front_x_m = there.centre_m.x + half_m.x;
    state.front_y_m = there.centre_m.y + half_m.y;
    state.yaw_rad = there.yaw_rad;
    state.speed_m_s = e->target_m_s;
    return state;
}

static double gap_at(const two_cars *e, double brake_s, double time_s)
{
    cp_vehicle_state own = exact_state(e, brake_s, 0, time_s);
    cp_rectangle one = cp_vehicle_rectangle(&own), other = two_cars_target_at(e, time_s);
    return cp_rectangle_separation(&one, &other);
}

// Moment of the first touch; NAN when there is none.
static double exact_touch_s(const two_cars *e, double brake_s)
{
    const double look_s = 0.004;
    for (double late_s = look_s; late_s < END_S; late_s += look_s) {
        if (gap_at(e, brake_s, late_s) > 0.0)
            continue;
        double early_s = late_s - look_s;
        for (int k = 0; k < 50; k++) {
            double middle_s = 0.5 * (early_s + late_s);
            *(gap_at(e, brake_s, middle_s) > 0.0 ? &early_s : &late_s) = middle_s;
        }
        return late_s;
    }
    return NAN;
}

// When to brake so that the own car touches at that speed.
static double brake_for(const two_cars *e, double touch_m_s)
{
    double early_s = 0.0, late_s = exact_touch_s(e, INFINITY);
    assert_true(late_s > 0.0);
    for (int k = 0; k < 40; k++) {
        double brake_s = 0.5 * (early_s + late_s), touch_s = exact_touch_s(e, brake_s);
        bool is_slower = isnan(touch_s) || own_speed_m_s(e, brake_s, touch_s) <= touch_m_s;
        *(is_slower ? &early_s : &late_s) = brake_s;
    }
    double touch_s = exact_touch_s(e, late_s);
    if (!(fabs(own_speed_m_s(e, late_s, touch_s) - touch_m_s) < 1e-6))
        fail_msg("%s: no touch at %g m/s, but at %g m/s", e->road, touch_m_s,
                 own_speed_m_s(e, late_s, touch_s));
    return late_s;
}

// ---- what the detector makes of it ---------------------------------------------------------

typedef struct outcome {
    size_t contacts; /* all that were reported; the rest is of the first */
    cp_contact_verdict verdict;
    const char *type;
    bool own_is_a;
    double time_s; /* from the beginning */
    double closing_speed_m_s, lateral_offset_m, angle_rad, own_speed_m_s;
} outcome;

static const char *id_of(const void *context, uint32_t vehicle)
{
    (void)context;
    return vehicle == 0 ? "own" : "target";
}

// In all of these: a standing car with a corner in the way is not left out as SUMO's doing.
static bool somebody_errs(void *context, uint32_t vehicle)
{
    (void)context;
    (void)vehicle;
    return true;
}

static void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s", error->text);
}

// One step of the two, [0] the own car, that ends time_s after the beginning.
static void look(cp_detector *detector, const cp_vehicle_motion motion[2], double step_length_s,
                 double time_s, outcome *found)
{
    cp_detector_scene scene = {.motions = motion,
                               .count = 2,
                               .step_length_s = step_length_s,
                               .time_s = time_s,
                               .vehicle_id = id_of,
                               .is_at_fault = somebody_errs};
    const cp_impact *impact;
    size_t count;
    cp_error error = {0};
    assert_ok(cp_detector_scan(detector, &scene, &impact, &count, &error), &error);
    if (count > 0 && found->contacts == 0) {
        cp_vehicle_model model = cp_vehicle_model_default();
        cp_crash_description description = cp_impact_describe(impact, &model, &model);
        int own = impact->vehicle[0] == 0 ? 0 : 1;
        *found = (outcome){.verdict = impact->verdict,
                           .type = cp_crash_type_text(impact->side[0], impact->side[1]),
                           .own_is_a = own == 0,
                           .time_s = impact->time_s,
                           .closing_speed_m_s = description.closing_speed_m_s,
                           .lateral_offset_m = description.lateral_offset_m,
                           .angle_rad = description.angle_rad,
                           .own_speed_m_s = impact->state[own].speed_m_s};
    }
    found->contacts += count;
}

static outcome without_sumo(const two_cars *e, double brake_s, double step_length_s)
{
    outcome found = {0};
    cp_detector *detector;
    cp_error error = {0};
    assert_ok(cp_detector_create(&detector, &error), &error);
    for (int k = 1; k * step_length_s < END_S && found.contacts == 0; k++) {
        cp_vehicle_motion motion[2];
        for (uint32_t v = 0; v < 2; v++) {
            motion[v] =
                (cp_vehicle_motion){.before = exact_state(e, brake_s, v, (k - 1) * step_length_s),
                                    .after = exact_state(e, brake_s, v, k * step_length_s),
                                    .was_present = true};
            motion[v].yaw_rate_rad_s =
                cp_wrap_angle(motion[v].after.yaw_rad - motion[v].before.yaw_rad) / step_length_s;
        }
        look(detector, motion, step_length_s, k * step_length_s, &found);
    }
    cp_detector_destroy(detector);
    return found;
}

// Speeds of the coming step's end; the drivers of SUMO have no say.
static void command(const cp_traffic *traffic, const two_cars *e, double brake_s, double end_s)
{
    const cp_traffic_source *commands = cp_traffic_commands(traffic);
    cp_error error = {0};
    for (int k = 0; k < 2; k++) {
        const cp_vehicle_motion *motion = two_cars_motion(traffic, id_of(NULL, (uint32_t)k));
        uint32_t vehicle = motion->after.vehicle;
        double speed_m_s = k == 0 ? own_speed_m_s(e, brake_s, end_s) : e->target_m_s;
        assert_ok(commands->set_speed_mode(vehicle, 0, &error), &error);
        assert_ok(commands->set_speed(vehicle, speed_m_s, &error), &error);
    }
}

static outcome in_sumo(const two_cars *e, double brake_s, double step_length_s)
{
    outcome found = {0};
    cp_traffic *traffic;
    cp_detector *detector;
    cp_error error = {0};
    double begun_s = NAN;
    assert_ok(two_cars_open(e, step_length_s, &traffic, &error), &error);
    assert_ok(cp_detector_create(&detector, &error), &error);
    for (int k = 0; k * step_length_s < END_S && found.contacts == 0; k++) {
        assert_ok(cp_traffic_step(traffic, &error), &error);
        const cp_vehicle_motion *own = two_cars_motion(traffic, "own");
        const cp_vehicle_motion *target = two_cars_motion(traffic, "target");
        if (own == NULL || target == NULL)
            break;
        // The first step only puts the cars there.
        begun_s = isnan(begun_s) ? cp_traffic_time_s(traffic) : begun_s;
        double now_s = cp_traffic_time_s(traffic) - begun_s;
        cp_vehicle_motion motion[2] = {*own, *target};
        for (uint32_t v = 0; v < 2; v++)
            motion[v].before.vehicle = motion[v].after.vehicle = v;
        look(detector, motion, step_length_s, now_s, &found);
        command(traffic, e, brake_s, now_s + step_length_s);
    }
    cp_detector_destroy(detector);
    cp_traffic_destroy(traffic);
    return found;
}

// ---- tests ---------------------------------------------------------------------------------

static void print_outcome(const char *name, const char *how, double step_length_s,
                          const outcome *found)
{
    print_message("%s, %s, step %g s: %s %s, t %.3f s, closing %.3f m/s, offset %.3f m, angle %.2f "
                  "deg, own %.3f m/s\n",
                  name, how, step_length_s, found->contacts ? found->type : "none",
                  found->contacts ? cp_contact_verdict_text(found->verdict) : "", found->time_s,
                  found->closing_speed_m_s, found->lateral_offset_m,
                  cp_deg_from_rad(found->angle_rad), found->own_speed_m_s);
}

/* Largest differences seen. */
typedef struct differences {
    double closing_m_s, offset_m, angle_deg;
} differences;

static void assert_same(const meeting *m, const outcome *one, const outcome *other,
                        differences *worst)
{
    differences now = {fabs(one->closing_speed_m_s - other->closing_speed_m_s),
                       fabs(one->lateral_offset_m - other->lateral_offset_m),
                       fabs(cp_deg_from_rad(cp_wrap_angle(one->angle_rad - other->angle_rad)))};
    bool is_same = one->contacts == 1 && other->contacts == 1 &&
                   one->verdict == CP_CONTACT_CONFIRMED && other->verdict == CP_CONTACT_CONFIRMED &&
                   strcmp(one->type, other->type) == 0 && one->own_is_a == other->own_is_a &&
                   (m->type == NULL || strcmp(one->type, m->type) == 0) &&
                   (m->type == NULL || one->own_is_a == m->own_is_a);
    if (!is_same || now.closing_m_s > CLOSING_M_S || now.offset_m > OFFSET_M ||
        now.angle_deg > ANGLE_DEG) {
        print_outcome(m->name, "one", 0.0, one);
        print_outcome(m->name, "other", 0.0, other);
        fail_msg("%s (ahead %.3f m): not the same crash, or not a %s", m->name, m->cars.ahead_m,
                 m->type);
    }
    *worst =
        (differences){fmax(worst->closing_m_s, now.closing_m_s),
                      fmax(worst->offset_m, now.offset_m), fmax(worst->angle_deg, now.angle_deg)};
}

static void a_crash_is_the_same_at_0_1_s_and_0_01_s(void **state)
{
    (void)state;
    for (size_t k = 0; k < UNBRAKED_COUNT; k++) {
        // The target a little further each time, so that they touch in every part of a step.
        differences steps = {0}, exact = {0};
        meeting m = UNBRAKED[k];
        for (int phase = 0; phase < 5; phase++) {
            m.cars.ahead_m = UNBRAKED[k].cars.ahead_m + 0.37 * phase / 5.0;
            outcome right = without_sumo(&m.cars, INFINITY, EXACT_STEP_S);
            outcome coarse = in_sumo(&m.cars, INFINITY, 0.1);
            outcome fine = in_sumo(&m.cars, INFINITY, 0.01);
            outcome made_up = without_sumo(&m.cars, INFINITY, 0.1);
            assert_same(&m, &coarse, &fine, &steps);
            assert_same(&m, &coarse, &right, &exact);
            assert_same(&m, &fine, &right, &exact);
            assert_same(&m, &made_up, &right, &exact);
        }
        print_message("%s: 0.1 s against 0.01 s %.3f m/s, %.3f m, %.2f deg; against the exact "
                      "motion %.3f m/s, %.3f m, %.2f deg\n",
                      m.name, steps.closing_m_s, steps.offset_m, steps.angle_deg, exact.closing_m_s,
                      exact.offset_m, exact.angle_deg);
    }
}

static void assert_braked(const meeting *m, double touch_m_s, double *worst_m_s)
{
    const double steps_s[] = {0.1, 0.05, 0.02};
    double own_m_s = touch_m_s;
    if (strcmp(m->cars.road, "ahead") == 0) // so much faster than the car ahead
        own_m_s += m->cars.target_m_s;
    double brake_s = brake_for(&m->cars, own_m_s);
    outcome right = without_sumo(&m->cars, brake_s, EXACT_STEP_S);
    for (size_t k = 0; k < sizeof steps_s / sizeof *steps_s; k++) {
        outcome found[2] = {in_sumo(&m->cars, brake_s, steps_s[k]),
                            without_sumo(&m->cars, brake_s, steps_s[k])};
        for (int sumo = 0; sumo < 2; sumo++) {
            double off_m_s = fmax(fabs(found[sumo].own_speed_m_s - own_m_s),
                                  fabs(found[sumo].closing_speed_m_s - right.closing_speed_m_s));
            bool good = found[sumo].contacts == 1 && found[sumo].verdict == CP_CONTACT_CONFIRMED &&
                        (steps_s[k] > 0.05 || off_m_s <= BRAKED_M_S) &&
                        (m->type == NULL || strcmp(found[sumo].type, m->type) == 0);
            if (!good) {
                print_outcome(m->name, "exact", EXACT_STEP_S, &right);
                print_outcome(m->name, sumo == 0 ? "SUMO" : "made up", steps_s[k], &found[sumo]);
                fail_msg("%s, touched at %g m/s", m->name, touch_m_s);
            }
            if (steps_s[k] <= 0.05)
                *worst_m_s = fmax(*worst_m_s, off_m_s);
        }
    }
}

static void a_braked_touch_at_1_2_3_m_s_is_a_crash(void **state)
{
    (void)state;
    for (size_t k = 0; k < BRAKED_COUNT; k++) {
        double worst_m_s = 0.0;
        for (int touch_m_s = 1; touch_m_s <= 3; touch_m_s++)
            assert_braked(&BRAKED[k], touch_m_s, &worst_m_s);
        print_message("%s: own and closing speed within %.3f m/s of the closed form\n",
                      BRAKED[k].name, worst_m_s);
    }
}

// Braked from the beginning to the last moment: every impact speed.
static void assert_as_in_closed_form(const meeting *m)
{
    const two_cars *e = &m->cars;
    double last_s = exact_touch_s(e, INFINITY), worst_m_s = 0.0;
    int crashes = 0;
    for (double brake_s = 0.0; brake_s < last_s; brake_s += 0.137) {
        double touch_s = exact_touch_s(e, brake_s);
        outcome found = in_sumo(e, brake_s, 0.05);
        if (isnan(touch_s)) {
            assert_int_equal(found.contacts, 0);
            continue;
        }
        outcome right = without_sumo(e, brake_s, EXACT_STEP_S);
        double own_m_s = own_speed_m_s(e, brake_s, touch_s);
        assert_int_equal(found.contacts, 1);
        assert_int_equal(found.verdict, right.verdict);
        worst_m_s = fmax(worst_m_s, fabs(found.own_speed_m_s - own_m_s));
        worst_m_s = fmax(worst_m_s, fabs(found.closing_speed_m_s - right.closing_speed_m_s));
        crashes++;
    }
    print_message("%s: %d contacts, within %.3f m/s of the closed form\n", m->name, crashes,
                  worst_m_s);
    assert_true(crashes > 3 && worst_m_s <= BRAKED_M_S);
}

static void a_braked_crash_is_as_in_closed_form(void **state)
{
    (void)state;
    for (size_t k = 0; k < BRAKED_COUNT; k++)
        assert_as_in_closed_form(&BRAKED[k]);
    assert_as_in_closed_form(&TURNING_IN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_crash_is_the_same_at_0_1_s_and_0_01_s),
        cmocka_unit_test(a_braked_touch_at_1_2_3_m_s_is_a_crash),
        cmocka_unit_test(a_braked_crash_is_as_in_closed_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
