/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crash_simulation.h"

#include "core/memory.h"
#include "core/units.h"
#include "crash/barrier.h"
#include "crash/barrier_party.h"
#include "crash/encounter.h"
#include "crash/film_camera.h"
#include "crash/struck_structure.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

cp_crash_options cp_crash_options_default(void)
{
    return (cp_crash_options){
        .time_step_s = 0.0005, .duration_s = 0.2, .longest_duration_s = 0.4, .coast_after_s = 0.01};
}

// ---- ODE as a library ------------------------------------------------------------------------

// ODE's own handlers abort without a word about who was running.
static void report_ode(int number, const char *format, va_list arguments)
{
    fprintf(stderr, "ODE message %d: ", number);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

static void report_ode_and_abort(int number, const char *format, va_list arguments)
{
    report_ode(number, format, arguments);
    abort();
}

// ODE writes through what it is given, in constructors and in its first step: without memory the
// process ends.
static void *allocate(dsizeint size)
{
    return cp_memory_or_end(size, "the physics engine ODE");
}

static void *allocate_again(void *memory, dsizeint old_size, dsizeint size)
{
    (void)old_size;
    return cp_memory_again_or_end(memory, size, "the physics engine ODE");
}

static void release(void *memory, dsizeint size)
{
    (void)size;
    free(memory);
}

cp_status cp_crash_library_begin(cp_error *error)
{
    dSetAllocHandler(allocate);
    dSetReallocHandler(allocate_again);
    dSetFreeHandler(release);
    if (!dInitODE2(0) || !dAllocateODEDataForThread(dAllocateMaskAll))
        return cp_fail(error, CP_CRASH_FAILED, "the physics engine ODE could not be initialised");
    dSetMessageHandler(report_ode);
    dSetErrorHandler(report_ode_and_abort);
    dSetDebugHandler(report_ode_and_abort);
    return CP_OK;
}

void cp_crash_library_end(void)
{
    dCloseODE();
}

bool cp_crash_library_is_double(void)
{
    return dCheckConfiguration("ODE_double_precision") != 0;
}

cp_status cp_crash_thread_begin(cp_error *error)
{
    if (!dAllocateODEDataForThread(dAllocateMaskAll))
        return cp_fail(error, CP_CRASH_FAILED, "ODE could not prepare a thread");
    return CP_OK;
}

void cp_crash_thread_end(void)
{
    dCleanupODEAllDataForThread();
}

// ---- one run ---------------------------------------------------------------------------------

// Everything that changes during a run. The plane is a's frame at first contact, moving along with
// the common centre of mass of two cars: what a common velocity adds is then added exactly, at
// the edge, and rounding does not depend on it.
typedef struct crash_run {
    const cp_crash_options *options;
    dWorldID world;
    dThreadingImplementationID threading;
    cp_car car[2];
    int car_count;
    cp_vec2 common_m_s; /* velocity of the plane */
    cp_encounter encounter;
    cp_contact_side side[2]; /* where each is struck */
    cp_pose start[2];
    cp_vec2 start_m_s[2];       /* of whole cars, seen from the plane */
    cp_body_state last[2];      /* centre of gravity at the end of the last step */
    cp_vec2 first_relative_m_s; /* of a against b at first contact */
    double last_approach_m_s;
    double before_elastic_j; /* when energy was taken last */
    double before_kinetic_j;
    size_t sample;
    cp_film_camera camera;
    cp_crash_result *result;
} crash_run;

static cp_body_state seen_from(cp_pose frame, cp_body_state state)
{
    return (cp_body_state){.cog_m = cp_pose_to_local(frame, state.cog_m),
                           .yaw_rad = cp_wrap_angle(state.yaw_rad - frame.yaw_rad),
                           .velocity_m_s = cp_vec2_rotate(state.velocity_m_s, -frame.yaw_rad),
                           .yaw_rate_rad_s = state.yaw_rate_rad_s};
}

// A world of its own, with its own threading, so that worlds on several threads do not meet.
static cp_status create_world(crash_run *run, cp_error *error)
{
    run->world = dWorldCreate();
    run->threading = dThreadingAllocateSelfThreadedImplementation();
    if (run->world == NULL || run->threading == NULL)
        return cp_fail_memory(error, "physics world");
    dWorldSetStepThreadingImplementation(
        run->world, dThreadingImplementationGetFunctions(run->threading), run->threading);
    dWorldSetGravity(run->world, 0.0, 0.0, 0.0);
    dWorldSetERP(run->world, 0.6);
    dWorldSetCFM(run->world, 1e-11);
    dWorldSetAutoDisableAverageSamplesCount(run->world, 0); // unused, and taken by operator new
    return CP_OK;
}

static void destroy_world(crash_run *run)
{
    if (run->world != NULL)
        dWorldDestroy(run->world);
    if (run->threading != NULL)
        dThreadingFreeImplementation(run->threading);
}

// Motion of the centre of gravity now, seen from the ground.
static cp_body_state ground_state(const crash_run *run, int c)
{
    cp_body_state state = cp_car_cog_state(&run->car[c]);
    double time_s = run->options->time_step_s * (double)run->sample;
    state.cog_m = cp_vec2_add(state.cog_m, cp_vec2_scale(run->common_m_s, time_s));
    state.velocity_m_s = cp_vec2_add(state.velocity_m_s, run->common_m_s);
    return state;
}

// Travel along the approach until the outlines just touch, from well before; false: they miss.
static bool find_first_touch(crash_run *run, cp_vec2 approach, double *travel_m)
{
    double s_m = -1.0;
    cp_displacement move[2] = {{{0.0, 0.0}, 0.0}, {{0.0, 0.0}, 0.0}};
    for (; s_m > -30.0; s_m -= 1.0) {
        move[0].shift_m = cp_vec2_scale(approach, s_m);
        if (cp_encounter_distance(&run->encounter, move, INFINITY) > 0.0)
            break;
    }
    while (s_m < 30.0) {
        move[0].shift_m = cp_vec2_scale(approach, s_m);
        double distance_m = cp_encounter_distance(&run->encounter, move, INFINITY);
        if (distance_m < 1e-9) {
            *travel_m = s_m;
            return true;
        }
        s_m += fmax(distance_m, 1e-9);
    }
    return false;
}

static void translate_car(cp_car *car, cp_vec2 shift_m)
{
    for (int k = 0; k < car->body_count; k++) {
        const dReal *p = dBodyGetPosition(car->body[k]);
        dBodySetPosition(car->body[k], p[0] + shift_m.x, p[1] + shift_m.y, 0.0);
    }
}

// A car with sides and rear unless it is struck on its front; or a barrier.
static cp_status build_party(cp_car *car, const cp_vehicle_model *model, cp_contact_side struck,
                             dWorldID world, const cp_body_state *state, cp_error *error)
{
    if (model->is_barrier) {
        cp_barrier_party_build(car, model, world, state);
        return CP_OK;
    }
    cp_status status = cp_car_build(car, model, world, state, error);
    if (status == CP_OK && struck != CP_SIDE_FRONT)
        cp_struck_build(car);
    return status;
}

// Build both parties in a's frame and move a along the relative velocity until they touch.
static cp_status set_up(crash_run *run, const cp_vehicle_model *models[2],
                        const cp_crash_configuration *configuration, cp_error *error)
{
    cp_pose frame = {configuration->vehicle[0].cog_m, configuration->vehicle[0].yaw_rad};
    cp_body_state states[2];
    for (int k = 0; k < run->car_count; k++)
        states[k] = seen_from(frame, configuration->vehicle[k]);
    if (run->car_count == 2) {
        double share = models[1]->mass_kg / (models[0]->mass_kg + models[1]->mass_kg);
        cp_vec2 apart = cp_vec2_sub(states[1].velocity_m_s, states[0].velocity_m_s);
        run->common_m_s = cp_vec2_add(states[0].velocity_m_s, cp_vec2_scale(apart, share));
    }
    cp_vec2 approach = {0.0, 0.0};
    for (int k = 0; k < run->car_count; k++) {
        cp_body_state state = states[k];
        state.velocity_m_s = cp_vec2_sub(state.velocity_m_s, run->common_m_s);
        cp_status status =
            build_party(&run->car[k], models[k], configuration->side[k], run->world, &state, error);
        if (status != CP_OK)
            return status;
        run->side[k] = configuration->side[k];
        run->encounter.car[k] = &run->car[k];
        approach = cp_vec2_add(approach, cp_vec2_scale(state.velocity_m_s, k == 0 ? 1.0 : -1.0));
    }
    run->encounter.friction_1 = models[0]->friction_1;
    if (run->car_count == 2) {
        run->encounter.friction_1 = sqrt(models[0]->friction_1 * models[1]->friction_1);
    } else {
        cp_pose pose = {cp_pose_to_local(frame, configuration->barrier_pose.position_m),
                        cp_wrap_angle(configuration->barrier_pose.yaw_rad - frame.yaw_rad)};
        run->encounter.barrier = cp_barrier_outline(&configuration->barrier, pose);
        if (configuration->barrier.friction_1 >= 0.0)
            run->encounter.friction_1 = configuration->barrier.friction_1;
    }

    cp_encounter_set_pairs(&run->encounter);

    double speed_m_s = cp_vec2_length(approach), travel_m = 0.0;
    if (speed_m_s > 0.0 &&
        find_first_touch(run, cp_vec2_scale(approach, 1.0 / speed_m_s), &travel_m)) {
        run->result->touched = true;
        run->result->shift_m = travel_m;
        translate_car(&run->car[0], cp_vec2_scale(approach, travel_m / speed_m_s));
    }
    for (int k = 0; k < run->car_count; k++) {
        run->last[k] = ground_state(run, k);
        run->start[k] = (cp_pose){run->last[k].cog_m, run->last[k].yaw_rad};
        run->start_m_s[k] = cp_vec2_sub(run->last[k].velocity_m_s, run->common_m_s);
    }
    return CP_OK;
}

// ---- recording -------------------------------------------------------------------------------

// Sample k of a pulse: motion now; the acceleration is the mean of the steps before and after, so
// the one after is added when it is known.
static void record_motion(cp_pulse *pulse, size_t k, const cp_pose *start,
                          const cp_body_state *state)
{
    cp_vec2 moved = cp_pose_to_local(*start, state->cog_m);
    pulse->channel[CP_CHANNEL_X][k] = moved.x;
    pulse->channel[CP_CHANNEL_Y][k] = moved.y;
    pulse->channel[CP_CHANNEL_YAW_RATE][k] = state->yaw_rate_rad_s;
    if (k == 0) {
        cp_vec2 velocity = cp_vec2_rotate(state->velocity_m_s, -state->yaw_rad);
        pulse->channel[CP_CHANNEL_VX][0] = velocity.x;
        pulse->channel[CP_CHANNEL_VY][0] = velocity.y;
        return;
    }
    double turned =
        cp_wrap_angle(state->yaw_rad - start->yaw_rad - pulse->channel[CP_CHANNEL_YAW][k - 1]);
    pulse->channel[CP_CHANNEL_YAW][k] = pulse->channel[CP_CHANNEL_YAW][k - 1] + turned;
}

static void record_step(crash_run *run, double dt)
{
    size_t k = ++run->sample;
    for (int c = 0; c < run->car_count; c++) {
        cp_pulse *pulse = &run->result->pulse[c];
        cp_body_state now = ground_state(run, c);

        // Acceleration of the step in the vehicle axes half-way through it.
        double turned = cp_wrap_angle(now.yaw_rad - run->last[c].yaw_rad);
        cp_vec2 change = cp_vec2_sub(now.velocity_m_s, run->last[c].velocity_m_s);
        cp_vec2 gain = cp_vec2_rotate(change, -(run->last[c].yaw_rad + 0.5 * turned));
        cp_vec2 acceleration = cp_vec2_scale(gain, 1.0 / dt);
        double yaw_acceleration = (now.yaw_rate_rad_s - run->last[c].yaw_rate_rad_s) / dt;
        record_motion(pulse, k, &run->start[c], &now);
        pulse->channel[CP_CHANNEL_VX][k] = pulse->channel[CP_CHANNEL_VX][k - 1] + gain.x;
        pulse->channel[CP_CHANNEL_VY][k] = pulse->channel[CP_CHANNEL_VY][k - 1] + gain.y;
        pulse->channel[CP_CHANNEL_AX][k - 1] += 0.5 * acceleration.x;
        pulse->channel[CP_CHANNEL_AY][k - 1] += 0.5 * acceleration.y;
        pulse->channel[CP_CHANNEL_YAW_ACC][k - 1] += 0.5 * yaw_acceleration;
        pulse->channel[CP_CHANNEL_AX][k] += 0.5 * acceleration.x;
        pulse->channel[CP_CHANNEL_AY][k] += 0.5 * acceleration.y;
        pulse->channel[CP_CHANNEL_YAW_ACC][k] += 0.5 * yaw_acceleration;
        run->last[c] = now;
    }
}

static void film_now(crash_run *run, double dt)
{
    cp_pose ground[2] = {{{0.0, 0.0}, 0.0}, {{0.0, 0.0}, 0.0}};
    for (int c = 0; c < run->car_count; c++)
        ground[c] = (cp_pose){run->last[c].cog_m, run->last[c].yaw_rad};
    cp_film_camera_take(&run->camera, run->sample, dt, run->car, ground, run->car_count);
}

// Start the film, if there is one, with its first frame.
static cp_status begin_film(crash_run *run, size_t last_sample, cp_error *error)
{
    double dt = run->options->time_step_s;
    const cp_outline *barrier = run->car_count == 1 ? &run->encounter.barrier : NULL;
    cp_status status = cp_film_camera_begin(&run->camera, run->options->film, last_sample, dt,
                                            run->start[0], barrier, error);
    if (status == CP_OK)
        film_now(run, dt);
    return status;
}

static void film_coasting(const crash_run *run, size_t last, double dt)
{
    for (size_t k = run->sample + 1; run->camera.film != NULL && k <= last; k++) {
        double t_s = dt * (double)(k - run->sample);
        cp_pose ground[2] = {{{0.0, 0.0}, 0.0}, {{0.0, 0.0}, 0.0}};
        for (int c = 0; c < run->car_count; c++) {
            const cp_body_state *state = &run->last[c];
            cp_vec2 moved = cp_vec2_scale(state->velocity_m_s, t_s);
            ground[c] = (cp_pose){cp_vec2_add(state->cog_m, moved),
                                  state->yaw_rad + t_s * state->yaw_rate_rad_s};
        }
        cp_film_camera_take_coasting(&run->camera, k, dt, ground, run->car_count);
    }
}

// Free of contact for good: constant world velocity and yaw rate to the end of the record.
static void coast(crash_run *run, size_t last, double dt)
{
    size_t from = run->sample;
    film_coasting(run, last, dt);
    for (int c = 0; c < run->car_count; c++) {
        cp_pulse *pulse = &run->result->pulse[c];
        cp_body_state state = run->last[c];
        for (size_t k = from + 1; k <= last; k++) {
            double t_s = dt * (double)(k - from);
            state.cog_m = cp_vec2_add(run->last[c].cog_m, cp_vec2_scale(state.velocity_m_s, t_s));
            state.yaw_rad = run->last[c].yaw_rad + t_s * state.yaw_rate_rad_s;
            record_motion(pulse, k, &run->start[c], &state);
            pulse->channel[CP_CHANNEL_VX][k] = pulse->channel[CP_CHANNEL_VX][k - 1];
            pulse->channel[CP_CHANNEL_VY][k] = pulse->channel[CP_CHANNEL_VY][k - 1];
        }
        run->last[c] = state;
    }
    run->sample = last;
}

// ---- the loop --------------------------------------------------------------------------------

static bool all_finite(const crash_run *run)
{
    for (int c = 0; c < run->car_count; c++) {
        const cp_body_state *state = &run->last[c];
        if (!isfinite(state->velocity_m_s.x) || !isfinite(state->velocity_m_s.y) ||
            !isfinite(state->yaw_rate_rad_s))
            return false;
    }
    return true;
}

// Whether the parties, moving on as they are, meet again before the horizon.
static bool will_meet_again(const crash_run *run, double horizon_s)
{
    const double look_s = 0.004;
    for (double t_s = look_s; t_s <= horizon_s; t_s += look_s) {
        cp_displacement move[2] = {{{0.0, 0.0}, 0.0}, {{0.0, 0.0}, 0.0}};
        for (int c = 0; c < run->car_count; c++)
            move[c] = (cp_displacement){
                cp_vec2_scale(cp_vec2_sub(run->last[c].velocity_m_s, run->common_m_s), t_s),
                run->last[c].yaw_rate_rad_s * t_s};
        if (isfinite(cp_encounter_distance(&run->encounter, move, 0.02)))
            return true;
    }
    return false;
}

// The highest mechanical energy so far, once the forces of a step are known. That of the step
// before: its forces, hence what it had stored, lie in the middle of the two velocities around it.
static void watch_energy(crash_run *run)
{
    cp_crash_energy *energy = &run->result->energy;
    double elastic_j = run->encounter.elastic_normal_j + run->encounter.elastic_friction_j;
    double kinetic_j = 0.0;
    for (int c = 0; c < run->car_count; c++) {
        kinetic_j += cp_car_kinetic_energy(&run->car[c]);
        elastic_j += run->car[c].elastic_j;
    }
    double middle_j = run->before_elastic_j + 0.5 * (run->before_kinetic_j + kinetic_j);
    energy->highest_mechanical_j = fmax(energy->highest_mechanical_j, middle_j);
    run->before_elastic_j = elastic_j;
    run->before_kinetic_j = kinetic_j;
}

static void sum_energy(crash_run *run)
{
    cp_crash_energy *energy = &run->result->energy;
    double blocks_j = 0.0; // of the contact's work, what blocks have taken
    energy->kinetic_j = 0.0;
    energy->elastic_j = run->encounter.elastic_normal_j + run->encounter.elastic_friction_j;
    energy->plastic_j = energy->rate_j = energy->mount_damping_j = 0.0;
    for (int c = 0; c < run->car_count; c++) {
        cp_car_absorbed absorbed = cp_car_energy_absorbed(&run->car[c]);
        energy->kinetic_j += cp_car_kinetic_energy(&run->car[c]);
        energy->elastic_j += cp_car_elastic_energy(&run->car[c]);
        energy->plastic_j += absorbed.longitudinal_j + absorbed.crash_box_j + absorbed.bending_j +
                             absorbed.engine_j + absorbed.corner_j + absorbed.upper_j +
                             absorbed.struck_j - run->car[c].mount_damping_j;
        energy->rate_j += absorbed.rate_j;
        energy->mount_damping_j += run->car[c].mount_damping_j;
        blocks_j += cp_car_block_energy(&run->car[c]);
    }
    energy->friction_j = run->encounter.friction_work_j - run->encounter.elastic_friction_j;
    energy->contact_damping_j =
        run->encounter.normal_work_j - run->encounter.elastic_normal_j - blocks_j;
    double middle_j = run->before_elastic_j + 0.5 * (run->before_kinetic_j + energy->kinetic_j);
    energy->highest_mechanical_j = fmax(energy->highest_mechanical_j, middle_j);
}

// A crash only takes energy. Where parameters, each within its bounds, are together too stiff for
// the time step, motion grows instead: nothing of it is a result.
static cp_status check_energy(const crash_run *run, double dt, cp_error *error)
{
    const double share_1 = 1.01, rounding_j = 10.0; // 0.1 m/s of a car
    const cp_crash_energy *energy = &run->result->energy;
    if (energy->highest_mechanical_j <= share_1 * energy->start_j + rounding_j)
        return CP_OK;
    return cp_fail(error, CP_CRASH_FAILED,
                   "the crash simulation gained energy: %.3g times that at first contact at %g s; "
                   "parameters of %s%s%s are together too stiff for the time step of %g s",
                   energy->highest_mechanical_j / energy->start_j, dt * (double)run->sample,
                   run->car[0].model->name, run->car_count == 2 ? " or " : "",
                   run->car_count == 2 ? run->car[1].model->name : "", dt);
}

static cp_crash_momentum momentum_now(const crash_run *run)
{
    cp_crash_momentum momentum = {{0.0, 0.0}, 0.0};
    cp_vec2 middle_m = run->start[0].position_m;
    if (run->car_count == 2)
        middle_m = cp_vec2_scale(cp_vec2_add(middle_m, run->start[1].position_m), 0.5);
    for (int c = 0; c < run->car_count; c++) {
        double angular_kg_m2_s = 0.0;
        cp_vec2 linear = cp_car_momentum(&run->car[c], &angular_kg_m2_s);
        momentum.angular_kg_m2_s += angular_kg_m2_s - cp_vec2_cross(middle_m, linear);
        linear = cp_vec2_add(linear, cp_vec2_scale(run->common_m_s, run->car[c].model->mass_kg));
        momentum.linear_kg_m_s = cp_vec2_add(momentum.linear_kg_m_s, linear);
    }
    return momentum;
}

// First zero of the relative velocity of the two cars along its first direction.
static void watch_common_velocity(crash_run *run, double time_s, double dt)
{
    if (run->car_count < 2 || isfinite(run->result->t_common_s))
        return;
    cp_vec2 relative = cp_vec2_sub(run->last[0].velocity_m_s, run->last[1].velocity_m_s);
    double now_m_s = cp_vec2_dot(relative, run->first_relative_m_s);
    double last_m_s = run->last_approach_m_s;
    if (now_m_s <= 0.0 && last_m_s > 0.0)
        run->result->t_common_s = time_s - dt * now_m_s / (now_m_s - last_m_s);
    run->last_approach_m_s = now_m_s;
}

// Whether every car's OLC lies behind: no later motion changes it. One that has none yet lies ahead
// when the motion goes on (awaited), and never comes when it has ended.
static bool olc_passed(const crash_run *run, bool awaited)
{
    double dt = run->options->time_step_s;
    for (int c = 0; c < run->car_count; c++) {
        cp_olc olc =
            cp_olc_from_velocity(run->result->pulse[c].channel[CP_CHANNEL_VX], run->sample + 1, dt);
        if (olc.status == CP_OLC_VALUE ? olc.t2_s > dt * (double)run->sample : awaited)
            return false;
    }
    return true;
}

// One step of the world; *pressed_n: how hard the parties pressed on each other.
static cp_status advance(crash_run *run, double dt, double *pressed_n, cp_error *error)
{
    for (int c = 0; c < run->car_count; c++)
        cp_car_apply_forces(&run->car[c]);
    cp_encounter_apply_forces(&run->encounter, dt);
    watch_energy(run);
    cp_status status = check_energy(run, dt, error);
    if (status != CP_OK)
        return status;
    if (!dWorldStep(run->world, dt))
        return cp_fail(error, CP_CRASH_FAILED, "the physics engine ODE refused the step at %g s",
                       dt * (double)run->sample);
    *pressed_n = cp_encounter_end_step(&run->encounter, dt);
    for (int c = 0; c < run->car_count; c++) {
        cp_car_after_step(&run->car[c], dt);
        cp_struck_after_step(&run->car[c]);
    }
    record_step(run, dt);
    film_now(run, dt);
    return CP_OK;
}

static cp_status simulate_contact(crash_run *run, cp_error *error)
{
    enum { OLC_EVERY = 20 };           // steps between two looks whether OLC is decided
    static const double LIGHT_N = 1e3; // wrecks that lean on each other
    const cp_crash_options *options = run->options;
    double dt = options->time_step_s;
    size_t wanted = (size_t)llround(options->duration_s / dt);
    size_t longest = (size_t)llround(fmax(options->duration_s, options->longest_duration_s) / dt);
    size_t coast_after = (size_t)llround(options->coast_after_s / dt);
    size_t last_pressed = 0, last_hard = 0;

    // Free from the beginning: nothing to simulate.
    bool free_again = !run->result->touched;
    while (!free_again && run->sample < longest) {
        double pressed_n = 0.0;
        cp_status status = advance(run, dt, &pressed_n, error);
        if (status != CP_OK)
            return status;
        if (pressed_n > LIGHT_N)
            last_hard = run->sample;
        if (pressed_n > 0.0) {
            last_pressed = run->sample;
            run->result->separation_s = dt * (double)run->sample;
        }
        if (!all_finite(run))
            return cp_fail(error, CP_CRASH_FAILED,
                           "the crash simulation left the finite numbers at %g s",
                           dt * (double)run->sample);
        watch_common_velocity(run, dt * (double)run->sample, dt);
        if (options->until_olc && run->sample % OLC_EVERY == 0 && olc_passed(run, true))
            return CP_OK;
        size_t quiet = run->sample - last_pressed;
        if (quiet >= coast_after && quiet % coast_after == 0)
            free_again = !will_meet_again(run, dt * (double)(longest - run->sample));

        // All that was asked for is there, and what still presses changes nothing.
        if (run->sample >= wanted && run->sample - last_hard >= coast_after &&
            olc_passed(run, true))
            free_again = true;
    }
    sum_energy(run);
    run->result->momentum_end = momentum_now(run);

    // The record ends when asked, or when contact has ended and OLC is decided, if that is later.
    size_t end = run->sample > wanted ? run->sample : wanted;
    if (run->sample < end)
        coast(run, end, dt);
    if (!olc_passed(run, false))
        coast(run, longest, dt);
    return CP_OK;
}

static double sum_of_parts(const cp_car_absorbed *part)
{
    return part->longitudinal_j + part->crash_box_j + part->bending_j + part->engine_j +
           part->corner_j + part->upper_j + part->struck_j + part->rate_j;
}

// What has become of each car as a whole.
static void evaluate_whole(crash_run *run)
{
    const cp_crash_energy *energy = &run->result->energy;
    double contact_j = (energy->friction_j + energy->contact_damping_j) / run->car_count;
    for (int c = 0; c < run->car_count; c++) {
        cp_crash_whole *whole = &run->result->whole[c];
        const cp_car *car = &run->car[c];
        double mass_kg = car->model->mass_kg, angular = 0.0;
        cp_vec2 velocity = cp_vec2_scale(cp_car_momentum(car, &angular), 1.0 / mass_kg);
        cp_vec2 change = cp_vec2_sub(velocity, run->start_m_s[c]);
        whole->delta_v_m_s = cp_vec2_rotate(change, -run->start[c].yaw_rad);
        whole->part = cp_car_energy_absorbed(car);
        whole->absorbed_j = fmax(0.0, sum_of_parts(&whole->part) + contact_j);
        whole->ees_m_s = sqrt(2.0 * whole->absorbed_j / mass_kg);
    }
}

// Delta-v is that of the whole car: the passenger cell's depends on how its front still swings.
static void take_whole_delta_v(const cp_crash_whole *whole, cp_severity *severity)
{
    severity->delta_v_m_s = cp_vec2_length(whole->delta_v_m_s);
    severity->delta_v_x_m_s = 0.0 - whole->delta_v_m_s.x;
    severity->delta_v_y_m_s = 0.0 - whole->delta_v_m_s.y;
    severity->pdof_rad =
        severity->delta_v_m_s > 1e-9
            ? cp_wrap_angle(atan2(whole->delta_v_m_s.y, whole->delta_v_m_s.x) + CP_PI)
            : (double)NAN;
}

static cp_status evaluate(crash_run *run, cp_error *error)
{
    evaluate_whole(run);
    cp_crash_result *result = run->result;
    for (int c = 0; c < run->car_count; c++) {
        result->pulse[c].sample_count = run->sample + 1;
        cp_status status = cp_severity_of_pulse(&result->pulse[c], result->separation_s,
                                                run->car_count == 1, &result->severity[c], error);
        if (status != CP_OK)
            return status;
        take_whole_delta_v(&result->whole[c], &result->severity[c]);
        result->crush_m[c] = run->car[c].crush_m;
        result->struck[c] = cp_struck_of(&run->car[c], run->side[c]);
    }
    return CP_OK;
}

// Start values of what is watched through the run.
static void begin_record(crash_run *run)
{
    cp_crash_result *result = run->result;
    result->t_common_s = NAN;
    for (int c = 0; c < run->car_count; c++)
        record_motion(&result->pulse[c], 0, &run->start[c], &run->last[c]);
    if (run->car_count == 2) {
        run->first_relative_m_s = cp_vec2_sub(run->last[0].velocity_m_s, run->last[1].velocity_m_s);
        run->last_approach_m_s = cp_vec2_dot(run->first_relative_m_s, run->first_relative_m_s);
    }
    sum_energy(run);
    run->before_elastic_j = result->energy.elastic_j;
    run->before_kinetic_j = result->energy.kinetic_j;
    result->energy.start_j = result->energy.kinetic_j;
    result->momentum_start = momentum_now(run);
}

static cp_status check_options(const cp_crash_options *options, const cp_vehicle_model *models[2],
                               cp_error *error)
{
    for (int k = 0; k < 2 && models[k] != NULL; k++) {
        double largest_s = cp_vehicle_model_largest_step(models[k], NULL);
        if (options->time_step_s > largest_s)
            return cp_fail(error, CP_BAD_INPUT,
                           "time_step_s must be at most %g for vehicle %s, found %g", largest_s,
                           models[k]->name, options->time_step_s);
    }
    if (!(options->time_step_s >= 1e-6 && options->time_step_s <= 0.002))
        return cp_fail(error, CP_BAD_INPUT, "time_step_s must be between 1e-6 and 0.002, found %g",
                       options->time_step_s);
    if (!(options->duration_s >= options->time_step_s && options->duration_s <= 2.0))
        return cp_fail(error, CP_BAD_INPUT, "duration_s must be between one step and 2, found %g",
                       options->duration_s);
    return CP_OK;
}

cp_status cp_crash_simulate(const cp_vehicle_model *model_a, const cp_vehicle_model *model_b,
                            const cp_crash_configuration *configuration,
                            const cp_crash_options *options, cp_crash_result *result,
                            cp_error *error)
{
    *result = (cp_crash_result){.vehicle_count = model_b != NULL ? 2 : 1};
    const cp_vehicle_model *models[2] = {model_a, model_b};
    cp_status status = check_options(options, models, error);
    if (status != CP_OK)
        return status;
    crash_run *run = calloc(1, sizeof *run);
    if (run == NULL)
        return cp_fail_memory(error, "crash simulation");
    run->options = options;
    run->result = result;
    run->car_count = result->vehicle_count;

    double longest_s = fmax(options->duration_s, options->longest_duration_s);
    size_t samples = (size_t)llround(longest_s / options->time_step_s) + 1;
    for (int c = 0; status == CP_OK && c < run->car_count; c++)
        status = cp_pulse_create(&result->pulse[c], samples, options->time_step_s, error);
    if (status == CP_OK)
        status = create_world(run, error);
    if (status == CP_OK)
        status = set_up(run, models, configuration, error);
    if (status == CP_OK) {
        begin_record(run);
        status = begin_film(run, samples - 1, error);
    }
    if (status == CP_OK)
        status = simulate_contact(run, error);
    if (status == CP_OK)
        status = evaluate(run, error);
    destroy_world(run);
    free(run);
    if (status != CP_OK)
        cp_crash_result_destroy(result);
    return status;
}

void cp_crash_result_destroy(cp_crash_result *result)
{
    for (int c = 0; c < 2; c++)
        cp_pulse_destroy(&result->pulse[c]);
    *result = (cp_crash_result){0};
}
