/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/animation.h"

#include "core/file.h"
#include "core/units.h"
#include "crash/validity.h"
#include "report/page.h"

#include <math.h>
#include <stdlib.h>

// Files of reports/ and the drawing library, embedded at build time.
extern const unsigned char cp_animation_html[];
extern const unsigned char cp_animation_css[];
extern const unsigned char cp_animation_js[];
extern const unsigned char cp_page_css[];
extern const unsigned char cp_page_d3_notice[];
extern const unsigned char cp_page_d3[];

// ---- numbers
// -------------------------------------------------------------------------------------

// A picture needs no more than tenths of a millimetre; short numbers keep the page small.
static json_t *rounded(double value, double unit)
{
    return isfinite(value) ? json_real(round(value / unit) * unit + 0.0) : json_null();
}

static json_t *length_json(double value_m)
{
    return rounded(value_m, 1e-4);
}

static json_t *angle_json(double value_rad)
{
    return rounded(value_rad, 1e-5);
}

static json_t *real_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

// ---- the film
// ------------------------------------------------------------------------------------

static json_t *shape_json(const cp_film_shape *shape)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "x_m", length_json(shape->centre_m.x), "y_m",
                     length_json(shape->centre_m.y), "yaw_rad", angle_json(shape->yaw_rad),
                     "length_m", length_json(shape->length_m), "width_m",
                     length_json(shape->width_m), "radius_m", length_json(shape->radius_m));
}

// Pose of a car in every frame, [x, y, yaw].
static json_t *poses_json(const cp_crash_film *film, int role)
{
    json_t *poses = json_array();
    for (size_t k = 0; k < film->frame_count; k++) {
        const cp_pose *pose = &film->frame[k].car[role].pose;
        json_array_append_new(poses, json_pack("[o, o, o]", length_json(pose->position_m.x),
                                               length_json(pose->position_m.y),
                                               angle_json(pose->yaw_rad)));
    }
    return poses;
}

// One part: what stays, and [x, y, yaw, length] in the car's axes in every frame.
static json_t *part_json(const cp_crash_film *film, int role, int part)
{
    json_t *frames = json_array();
    for (size_t k = 0; k < film->frame_count; k++) {
        const cp_film_shape *shape = &film->frame[k].car[role].part[part];
        json_array_append_new(frames,
                              json_pack("[o, o, o, o]", length_json(shape->centre_m.x),
                                        length_json(shape->centre_m.y), angle_json(shape->yaw_rad),
                                        length_json(shape->length_m)));
    }
    const cp_film_shape *first = &film->frame[0].car[role].part[part];
    return json_pack("{s:s, s:o, s:o, s:o}", "name", CP_FILM_PART_TEXT[part], "width_m",
                     length_json(first->width_m), "radius_m", length_json(first->radius_m),
                     "frames", frames);
}

static json_t *parts_json(const cp_crash_film *film, int role)
{
    json_t *parts = json_array();
    for (int part = 0; part < CP_FILM_PART_COUNT; part++)
        json_array_append_new(parts, part_json(film, role, part));
    return parts;
}

// ---- pulses and what became of a vehicle
// ----------------------------------------------------------

static json_t *channel_json(const cp_pulse *pulse, cp_pulse_channel channel, double factor,
                            double unit)
{
    json_t *values = json_array();
    for (size_t k = 0; k < pulse->sample_count; k++)
        json_array_append_new(values, rounded(factor * pulse->channel[channel][k], unit));
    return values;
}

static cp_status pulse_json(const cp_pulse *raw, json_t **json, cp_error *error)
{
    cp_pulse pulse = {0};
    cp_status status = cp_pulse_filtered(raw, 60.0, &pulse, error);
    if (status == CP_OK)
        *json = json_pack("{s:o, s:o, s:o, s:o}", "interval_ms",
                          json_real(1e3 * pulse.sample_interval_s), "a_g",
                          channel_json(&pulse, CP_CHANNEL_AX, 1.0 / CP_G0_M_S2, 1e-3), "v_km_h",
                          channel_json(&pulse, CP_CHANNEL_VX, 3.6, 1e-3), "s_mm",
                          channel_json(&pulse, CP_CHANNEL_X, 1e3, 1e-2));
    cp_pulse_destroy(&pulse);
    return status;
}

static json_t *severity_json(const cp_animated_run *run, int role)
{
    const cp_severity *s = &run->result->severity[role];
    bool frontal = run->configuration->side[role] == CP_SIDE_FRONT;
    cp_olc_status olc_status = frontal ? s->olc.status : CP_OLC_NOT_FRONT_CONTACT;
    double olc_g = frontal ? s->olc.olc_g : NAN;
    char text[CP_VALIDITY_TEXT_SIZE];
    unsigned outside =
        cp_validity(run->model[0], run->model[1], run->configuration, run->description, role, NULL);
    return json_pack("{s:s, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "contact_side",
                     cp_contact_side_text(run->configuration->side[role]), "validity",
                     cp_validity_text(outside, text), "olc_status", cp_olc_status_text(olc_status),
                     "olc_g", real_json(olc_g), "olc_t1_ms", real_json(1e3 * s->olc.t1_s),
                     "olc_t2_ms", real_json(1e3 * s->olc.t2_s), "delta_v_km_h",
                     real_json(cp_km_h_from_m_s(s->delta_v_m_s)), "peak_g", real_json(s->peak_g),
                     "t_v0_ms", real_json(1e3 * s->t_v0_s), "crush_mm",
                     real_json(1e3 * run->result->crush_m[role]));
}

static cp_status vehicle_json(const cp_animated_run *run, int role, json_t **json, cp_error *error)
{
    const cp_vehicle_model *model = run->model[role];
    json_t *pulse = NULL;
    cp_status status = pulse_json(&run->result->pulse[role], &pulse, error);
    if (status != CP_OK)
        return status;
    *json = json_pack(
        "{s:s, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "role", role == 0 ? "a" : "b", "name",
        model->name, "description", model->description, "length_m", length_json(model->length_m),
        "width_m", length_json(model->width_m), "cg_to_front_m", length_json(model->cg_to_front_m),
        "severity", severity_json(run, role), "poses", poses_json(run->film, role), "parts",
        parts_json(run->film, role), "pulse", pulse);
    return CP_OK;
}

// ---- a run and the page
// ----------------------------------------------------------------------------

static json_t *times_json(const cp_crash_film *film)
{
    json_t *times = json_array();
    for (size_t k = 0; k < film->frame_count; k++)
        json_array_append_new(times, rounded(1e3 * film->frame[k].time_s, 1e-6));
    return times;
}

cp_status cp_animation_run_json(const cp_animated_run *run, json_t **json, cp_error *error)
{
    if (run->film->frame_count == 0)
        return cp_fail(error, CP_BAD_INPUT, "nothing was filmed of a crash to animate");
    json_t *vehicles = json_array();
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < run->result->vehicle_count; role++) {
        json_t *vehicle = NULL;
        status = vehicle_json(run, role, &vehicle, error);
        if (status == CP_OK)
            json_array_append_new(vehicles, vehicle);
    }
    if (status != CP_OK) {
        json_decref(vehicles);
        return status;
    }
    const cp_crash_description *d = run->description;
    bool barrier = run->film->against_barrier;
    *json =
        json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "vehicle",
                  run->model[0]->name, "against", barrier ? "barrier" : run->model[1]->name,
                  "speed_km_h", real_json(cp_km_h_from_m_s(d->speed_m_s[0])), "opponent_speed_km_h",
                  barrier ? json_null() : real_json(cp_km_h_from_m_s(d->speed_m_s[1])),
                  "closing_speed_km_h", real_json(cp_km_h_from_m_s(d->closing_speed_m_s)),
                  "offset_mm", real_json(1e3 * d->lateral_offset_m), "angle_deg",
                  real_json(cp_deg_from_rad(d->angle_rad)), "overlap_1", real_json(d->overlap_1),
                  "barrier", barrier ? shape_json(&run->film->barrier) : json_null(), "times_ms",
                  times_json(run->film), "vehicles", vehicles);
    return CP_OK;
}

static cp_status page_json(const cp_animated_run *run, size_t run_count, json_t **json,
                           cp_error *error)
{
    json_t *runs = json_array();
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < run_count; k++) {
        json_t *one = NULL;
        status = cp_animation_run_json(&run[k], &one, error);
        if (status == CP_OK)
            json_array_append_new(runs, one);
    }
    // What could not be packed for want of memory is NULL and was not appended.
    if (status == CP_OK && json_array_size(runs) < run_count)
        status = cp_fail_memory(error, "an animation");
    if (status == CP_OK)
        *json = json_pack("{s:O}", "runs", runs);
    json_decref(runs);
    return status;
}

static cp_status write_page(const json_t *data, const char *title, const char *path,
                            cp_error *error)
{
    char *safe_title = cp_page_escape(title), *json = cp_page_json_text(data);
    char *notice = cp_page_escape((const char *)cp_page_d3_notice);
    char *page = NULL;
    size_t size = 0;
    cp_status status;
    if (!safe_title || !json || !notice) {
        status = cp_fail_memory(error, "an animation");
        goto done;
    }
    const cp_page_part parts[] = {
        {"version", CRASHPULSE_VERSION},
        {"title", safe_title},
        {"style", (const char *)cp_page_css},
        {"animation_style", (const char *)cp_animation_css},
        {"d3", (const char *)cp_page_d3},
        {"d3_notice", notice},
        {"script", (const char *)cp_animation_js},
        {"data", json},
    };
    status = cp_page_fill((const char *)cp_animation_html, parts, sizeof parts / sizeof *parts,
                          &page, &size, error);
    if (status == CP_OK)
        status = cp_file_write(path, page, size, error);

done:
    free(page);
    free(notice);
    free(json);
    free(safe_title);
    return status;
}

cp_status cp_animation_write(const cp_animated_run *run, size_t run_count, const char *path,
                             cp_error *error)
{
    json_t *data = NULL;
    char title[256];
    snprintf(title, sizeof title, "%s at %.4g km/h against %s", run[0].model[0]->name,
             cp_km_h_from_m_s(run[0].description->speed_m_s[0]),
             run[0].model[1] ? run[0].model[1]->name : "a rigid barrier");
    cp_status status = page_json(run, run_count, &data, error);
    if (status == CP_OK && data == NULL)
        status = cp_fail_memory(error, "an animation");
    if (status == CP_OK)
        status = write_page(data, title, path, error);
    json_decref(data);
    return status;
}
