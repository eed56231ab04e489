/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_builder.h"
#include "builders/crash_library.h"
#include "crash/contact.h"

#include <string.h>

// A filmed crash at 56 km/h; opponent NULL: the barrier. The caller destroys both.
static cp_crash_result film_crash(const cp_vehicle_model *opponent, double offset_mm,
                                  double angle_deg, cp_crash_film *film)
{
    cp_vehicle_model car = cp_vehicle_model_default();
    // Its crash boxes are never pressed to less than nothing.
    car.crash_box_collapse_end_m = 0.15;
    cp_crash_configuration configuration =
        crash_builder_configuration(&car, opponent, 56.0, 56.0, offset_mm, angle_deg);
    cp_crash_options options = cp_crash_options_default();
    options.film = film;
    return crash_builder_simulate(&car, opponent, &configuration, &options);
}

// A part of a frame on the ground.
static cp_outline outline_of(const cp_film_car *car, int part)
{
    const cp_film_shape *shape = &car->part[part];
    return (cp_outline){.centre_m = cp_pose_to_world(car->pose, shape->centre_m),
                        .along = cp_vec2_heading(car->pose.yaw_rad + shape->yaw_rad),
                        .half_length_m = 0.5 * shape->length_m,
                        .half_width_m = 0.5 * shape->width_m,
                        .radius_m = shape->radius_m};
}

static void frames_come_at_their_times(void **state)
{
    (void)state;
    cp_crash_film film = {.interval_s = 0.002};
    cp_crash_result result = film_crash(NULL, 0.0, 0.0, &film);
    assert_int_equal(film.frame_count, (result.pulse[0].sample_count - 1) / 4 + 1);
    for (size_t k = 0; k < film.frame_count; k++) {
        const cp_pose *pose = &film.frame[k].car[0].pose;
        assert_near(film.frame[k].time_s, 0.002 * (double)k, 1e-12);
        // Where the pulse says the centre of gravity is.
        assert_near(pose->position_m.x, result.pulse[0].channel[CP_CHANNEL_X][4 * k], 1e-9);
        assert_near(pose->yaw_rad, result.pulse[0].channel[CP_CHANNEL_YAW][4 * k], 1e-9);
    }
    cp_crash_result_destroy(&result);
    cp_crash_film_destroy(&film);
    assert_null(film.frame);
    assert_near(film.interval_s, 0.002, 0.0);
}

static void the_first_frame_shows_undeformed_cars_that_touch(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_film film = cp_crash_film_default();
    cp_crash_result result = film_crash(&car, 300.0, 10.0, &film);
    const cp_film_frame *first = &film.frame[0];
    assert_near(first->time_s, 0.0, 0.0);
    assert_near(first->car[0].pose.position_m.x, 0.0, 1e-12);
    assert_near(first->car[1].pose.yaw_rad, cp_wrap_angle(CP_PI + cp_rad_from_deg(10.0)), 1e-9);

    double nearest_m = INFINITY;
    for (int i = 0; i < CP_FILM_PART_COUNT; i++) {
        for (int j = 0; j < CP_FILM_PART_COUNT; j++) {
            cp_outline one = outline_of(&first->car[0], i), other = outline_of(&first->car[1], j);
            nearest_m = fmin(nearest_m, cp_outline_distance(&one, &other));
        }
    }
    assert_near(nearest_m, 0.0, 1e-6);
    for (int c = 0; c < 2; c++) {
        const cp_film_shape *part = first->car[c].part;
        assert_near(part[CP_FILM_LONGITUDINAL_LEFT].length_m, car.longitudinal_length_m, 1e-9);
        assert_near(part[CP_FILM_CRASH_BOX_RIGHT].length_m, car.crash_box_length_m, 1e-9);
        assert_near(part[CP_FILM_LONGITUDINAL_LEFT].centre_m.y, car.longitudinal_y_m, 1e-9);
        double front_m = part[CP_FILM_CROSS_MEMBER_LEFT].centre_m.x +
                         0.5 * part[CP_FILM_CROSS_MEMBER_LEFT].length_m;
        assert_near(front_m, car.cg_to_front_m, 1e-9);
        double rear_m = part[CP_FILM_BODY].centre_m.x - 0.5 * part[CP_FILM_BODY].length_m;
        assert_near(rear_m, car.cg_to_front_m - car.length_m, 1e-9);
    }
    cp_crash_result_destroy(&result);
    cp_crash_film_destroy(&film);
}

static void members_shorten_as_the_front_is_crushed(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_film film = {.interval_s = 0.0005}; // every step
    cp_crash_result result = film_crash(NULL, 0.0, 0.0, &film);
    double shortest_m = INFINITY;
    for (size_t k = 0; k < film.frame_count; k++) {
        const cp_film_shape *part = film.frame[k].car[0].part;
        double length_m =
            part[CP_FILM_LONGITUDINAL_LEFT].length_m + part[CP_FILM_CRASH_BOX_LEFT].length_m;
        shortest_m = fmin(shortest_m, length_m);
    }
    double undeformed_m = car.longitudinal_length_m + car.crash_box_length_m;
    assert_true(result.crush_m[0] > 0.3);
    assert_near(undeformed_m - shortest_m, result.crush_m[0], 0.002);

    // The barrier's face is where the bumper touched it.
    assert_true(film.against_barrier);
    assert_near(film.barrier.centre_m.x - 0.5 * film.barrier.length_m, car.cg_to_front_m, 1e-6);
    cp_crash_result_destroy(&result);
    cp_crash_film_destroy(&film);
}

// A struck side moves in by as much as the crash says; a barrier is its body alone.
static void a_struck_side_is_seen_pushed_in(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_barrier wall = cp_barrier_default();
    cp_vehicle_model barrier = cp_vehicle_model_of_barrier(&wall);
    cp_crash_configuration configuration;
    cp_error error = {0};
    assert_int_equal(cp_crash_configuration_struck(&car, &barrier, CP_SIDE_LEFT, 0.0, 0.0, 0.0, 9.0,
                                                   &configuration, &error),
                     CP_OK);
    cp_crash_film film = cp_crash_film_default();
    cp_crash_options options = cp_crash_options_default();
    options.film = &film;
    cp_crash_result result = crash_builder_simulate(&car, &barrier, &configuration, &options);
    const cp_film_shape *first = &film.frame[0].car[0].part[CP_FILM_BODY];
    const cp_film_shape *last = &film.frame[film.frame_count - 1].car[0].part[CP_FILM_BODY];
    assert_near(first->width_m, car.width_m, 1e-9);
    assert_true(result.struck[0].depth_m > 0.1);
    assert_near(first->width_m - last->width_m, result.struck[0].depth_m, 1e-6);
    assert_near(last->centre_m.y, -0.5 * result.struck[0].depth_m, 1e-6);
    const cp_film_shape *part = film.frame[0].car[1].part;
    assert_near(part[CP_FILM_BODY].length_m, wall.depth_m, 1e-9);
    assert_near(part[CP_FILM_ENGINE].length_m, 0.0, 0.0);
    cp_crash_result_destroy(&result);
    cp_crash_film_destroy(&film);
}

static void filming_changes_nothing(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_film film = {.interval_s = 0.0005};
    cp_crash_result filmed = film_crash(&car, -250.0, 15.0, &film);
    cp_crash_result alone = film_crash(&car, -250.0, 15.0, NULL);
    assert_int_equal(filmed.pulse[0].sample_count, alone.pulse[0].sample_count);
    assert_int_equal(film.frame_count, alone.pulse[0].sample_count);
    for (int c = 0; c < 2; c++)
        for (int channel = 0; channel < CP_CHANNEL_COUNT; channel++)
            assert_memory_equal(filmed.pulse[c].channel[channel], alone.pulse[c].channel[channel],
                                sizeof(double) * alone.pulse[c].sample_count);

    // The same film again: frames of the new crash only.
    cp_crash_result again = film_crash(NULL, 0.0, 0.0, &film);
    assert_near(film.frame[0].time_s, 0.0, 0.0);
    assert_int_equal(film.frame_count, again.pulse[0].sample_count);
    cp_crash_result_destroy(&again);
    cp_crash_result_destroy(&alone);
    cp_crash_result_destroy(&filmed);
    cp_crash_film_destroy(&film);
}

static void a_film_without_interval_is_refused(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration configuration =
        crash_builder_configuration(&car, NULL, 56.0, 0.0, 0.0, 0.0);
    cp_crash_film film = {.interval_s = 0.0};
    cp_crash_options options = cp_crash_options_default();
    options.film = &film;
    cp_crash_result result;
    cp_error error = {0};
    assert_int_equal(cp_crash_simulate(&car, NULL, &configuration, &options, &result, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "interval_s"));
    cp_crash_film_destroy(&film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_come_at_their_times),
        cmocka_unit_test(the_first_frame_shows_undeformed_cars_that_touch),
        cmocka_unit_test(members_shorten_as_the_front_is_crushed),
        cmocka_unit_test(a_struck_side_is_seen_pushed_in),
        cmocka_unit_test(filming_changes_nothing),
        cmocka_unit_test(a_film_without_interval_is_refused),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
