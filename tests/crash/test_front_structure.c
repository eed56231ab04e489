/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_library.h"

#include "builders/crash_builder.h"
#include "crash/front_structure.h"

#include <string.h>

// In place: ODE keeps addresses within the car.
static void build(cp_car *car, dWorldID world, const cp_vehicle_model *model,
                  const cp_body_state *state)
{
    cp_error error = {0};
    if (cp_car_build(car, model, world, state, &error) != CP_OK)
        crash_builder_stop(&error);
}

static void the_bodies_add_up_to_the_car(void **state)
{
    (void)state;
    // Turning about its centre of gravity the car's momentum and energy are those of one rigid
    // body of its mass and yaw inertia.
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_body_state motion = {{3.0, -2.0}, 0.7, {5.0, 1.0}, 2.0};
    dWorldID world = dWorldCreate();
    cp_car car;
    build(&car, world, &model, &motion);
    double angular = 0.0;
    cp_vec2 momentum = cp_car_momentum(&car, &angular);
    assert_near(momentum.x, 5.0 * model.mass_kg, 1e-8);
    assert_near(momentum.y, 1.0 * model.mass_kg, 1e-8);
    double expected = cp_vec2_cross(motion.cog_m, momentum) + 2.0 * model.yaw_inertia_kg_m2;
    assert_near(angular, expected, 1e-7);
    double energy_j = 0.5 * model.mass_kg * 26.0 + 0.5 * model.yaw_inertia_kg_m2 * 4.0;
    assert_near(cp_car_kinetic_energy(&car), energy_j, 1e-7);
    cp_body_state back = cp_car_cog_state(&car);
    assert_near(back.cog_m.x, 3.0, 1e-12);
    assert_near(back.cog_m.y, -2.0, 1e-12);
    assert_near(car.mass_kg[CP_BODY_ROOT], cp_vehicle_model_cell_mass(&model), 1e-9);
    dWorldDestroy(world);
}

static void an_undisturbed_car_stays_rigid_and_in_its_plane(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_body_state motion = {{0.0, 0.0}, 0.3, {12.0, 2.0}, 0.0};
    dWorldID world = dWorldCreate();
    cp_car car;
    build(&car, world, &model, &motion);
    for (int k = 0; k < 400; k++) {
        cp_car_apply_forces(&car);
        dWorldStep(world, 0.0005);
        cp_car_after_step(&car, 0.0005);
    }
    cp_body_state end = cp_car_cog_state(&car);
    assert_near(end.cog_m.x, 12.0 * 0.2, 1e-9);
    assert_near(end.cog_m.y, 2.0 * 0.2, 1e-9);
    assert_near(end.yaw_rad, 0.3, 1e-9);
    cp_car_absorbed absorbed = cp_car_energy_absorbed(&car);
    assert_near(cp_car_elastic_energy(&car) + absorbed.bending_j + absorbed.engine_j, 0.0, 1e-3);
    for (int k = 0; k < CP_BODY_COUNT; k++) {
        assert_true(dBodyGetPosition(car.body[k])[2] == 0.0);
        assert_true(dBodyGetAngularVel(car.body[k])[0] == 0.0);
    }
    dWorldDestroy(world);
}

static cp_crush_law two_points(double begin_m, double begin_n, double end_m, double end_n,
                               double unload_n_m)
{
    return (cp_crush_law){.points = 2,
                          .s_m = {begin_m, end_m},
                          .force_n = {begin_n, end_n},
                          .stop_n_m = 1e6,
                          .plateau_n = INFINITY,
                          .unload_n_m = unload_n_m,
                          .unload_end_n_m = unload_n_m};
}

// A mass running into one crush element: (time of standstill, largest compression).
static void run_mass(double mass_kg, double speed_m_s, const cp_crush_law *law, double dt,
                     double *stop_s, double *crush_m)
{
    dWorldID world = dWorldCreate();
    dBodyID body = dBodyCreate(world);
    dMass mass;
    dMassSetParameters(&mass, mass_kg, 0, 0, 0, 1, 1, 1, 0, 0, 0);
    dBodySetMass(body, &mass);
    dBodySetLinearVel(body, speed_m_s, 0, 0);
    cp_crush_state crush = {0};
    *stop_s = 0.0;
    *crush_m = 0.0;
    double last_m_s = speed_m_s;
    for (int k = 1; *stop_s <= 0.0; k++) {
        dBodyAddForce(body, -cp_crush_force(law, &crush, dBodyGetPosition(body)[0]), 0, 0);
        dWorldStep(world, dt);
        double now_m_s = dBodyGetLinearVel(body)[0];
        if (now_m_s <= 0.0)
            *stop_s = dt * (k - now_m_s / (now_m_s - last_m_s));
        last_m_s = now_m_s;
        *crush_m = fmax(*crush_m, dBodyGetPosition(body)[0]);
    }
    dWorldDestroy(world);
}

static void a_mass_on_the_elastic_part_follows_the_quarter_cosine(void **state)
{
    (void)state;
    const cp_crush_law law = two_points(0.5, 5e5, 1.0, 6e5, 2e6);
    double mass_kg = 1500.0, speed_m_s = 8.0, stop_s, crush_m;
    double omega_rad_s = sqrt(1e6 / mass_kg);
    run_mass(mass_kg, speed_m_s, &law, 1e-4, &stop_s, &crush_m);
    assert_near(stop_s, 0.5 * CP_PI / omega_rad_s, 2e-4);
    assert_near(crush_m, speed_m_s / omega_rad_s, 5e-4);
}

static void a_mass_on_constant_force_stops_by_energy(void **state)
{
    (void)state;
    // 1 mm of rise, then 300 kN: v^2 m / 2 = F (s - rise / 2).
    const cp_crush_law law = two_points(0.001, 3e5, 2.0, 3e5, 1e9);
    double mass_kg = 1500.0, speed_m_s = 15.0, stop_s, crush_m;
    run_mass(mass_kg, speed_m_s, &law, 1e-5, &stop_s, &crush_m);
    assert_near(crush_m, 0.5 * mass_kg * speed_m_s * speed_m_s / 3e5 + 0.0005, 2e-4);
    assert_near(stop_s, mass_kg * speed_m_s / 3e5, 2e-4);
}

// The face of a block is where its crush has brought it, also when that is more than the front has
// room for: then what is left of it is in the passenger cell, whose front has gone as far.
static void the_face_of_a_block_goes_as_far_as_its_crush(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    model.corner_strips_1 = 2;
    cp_body_state state_at_rest = {0};
    dWorldID world = dWorldCreate();
    cp_car car;
    build(&car, world, &model, &state_at_rest);
    for (int index = CP_OUTLINE_BLOCKS; index < car.outline_count; index++) {
        cp_crush_block *block = &car.block[car.outline[index].block];
        cp_outline whole = cp_car_outline_now(&car, index);
        double face_m = whole.centre_m.x + whole.half_length_m;
        for (double crush_m = 0.0; crush_m < 1.3; crush_m += 0.1) {
            block->s_m = crush_m;
            cp_outline now = cp_car_outline_now(&car, index);
            assert_near(now.centre_m.x + now.half_length_m, face_m - crush_m, 1e-12);
            assert_near(now.half_width_m, whole.half_width_m, 0.0);
            assert_true(now.half_length_m >= now.radius_m);
            double rear_m = now.centre_m.x - now.half_length_m;
            double rear_whole_m = whole.centre_m.x - whole.half_length_m;
            assert_true(rear_m < rear_whole_m + 1e-12);

            // The cell begins behind it.
            cp_car_after_step(&car, 0.0005);
            cp_outline cell = cp_car_outline_now(&car, CP_OUTLINE_BODY);
            assert_true(cell.centre_m.x + cell.half_length_m < rear_m + 1e-9);
        }
    }
    dWorldDestroy(world);
}

static void masses_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    model.yaw_inertia_kg_m2 = 600.0;
    dWorldID world = dWorldCreate();
    cp_car car;
    cp_error error = {0};
    cp_body_state motion = {{0.0, 0.0}, 0.0, {0.0, 0.0}, 0.0};
    assert_int_equal(cp_car_build(&car, &model, world, &motion, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "yaw_inertia_kg_m2"));
    dWorldDestroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bodies_add_up_to_the_car),
        cmocka_unit_test(an_undisturbed_car_stays_rigid_and_in_its_plane),
        cmocka_unit_test(a_mass_on_the_elastic_part_follows_the_quarter_cosine),
        cmocka_unit_test(a_mass_on_constant_force_stops_by_energy),
        cmocka_unit_test(the_face_of_a_block_goes_as_far_as_its_crush),
        cmocka_unit_test(masses_that_do_not_fit_are_refused),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
