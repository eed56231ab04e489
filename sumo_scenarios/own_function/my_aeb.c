/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <crashpulse/function.h>

/* An emergency brake of one's own: it brakes when an object that the sensor knows would overlap the
 * own car within ttc_s, both straight on as now, and until that is release_ttc_s away. */

enum { TTC_S, RELEASE_TTC_S, DECELERATION_M_S2, RANGE_M };

static const crashpulse_parameter PARAMETERS[] = {
    [TTC_S] = {"ttc_s", 1.0, 0.1, 5.0, "brakes below this time to collision, s (assumed)"},
    [RELEASE_TTC_S] = {"release_ttc_s", 2.5, 0.1, 20.0, "and until it is above this, s (assumed)"},
    [DECELERATION_M_S2] = {"deceleration_m_s2", 8.0, 0.5, 12.0, "how hard, m/s^2 (assumed)"},
    [RANGE_M] = {"sensor_range_m", 100.0, 1.0, 500.0, "the host's sensor, m (assumed)"},
};

typedef struct car {
    bool is_braking;
} car;

static const char *create(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **self)
{
    if (setup->parameter[RELEASE_TTC_S] < setup->parameter[TTC_S])
        return "release_ttc_s must not be less than ttc_s";
    outlook->horizon_s = setup->parameter[RELEASE_TTC_S] + 1.0;
    *self = (void *)setup->parameter; // all it needs to know
    return NULL;
}

/* Times between which something overlaps along one axis. */
typedef struct span {
    double from_s, to_s;
} span;

// A body that reaches half_m to both sides of at_m and moves, and the own one from low_m to high_m.
static span overlap(double at_m, double half_m, double speed_m_s, double low_m, double high_m)
{
    double one_m = low_m - (at_m + half_m), other_m = high_m - (at_m - half_m);
    if (fabs(speed_m_s) < 1e-9)
        return one_m < 0.0 && other_m > 0.0 ? (span){0.0, INFINITY} : (span){INFINITY, 0.0};
    double one_s = one_m / speed_m_s, other_s = other_m / speed_m_s;
    return (span){fmin(one_s, other_s), fmax(one_s, other_s)};
}

static double ttc_s(const crashpulse_view *own, const crashpulse_object *other)
{
    double c = cos(other->heading_rad), s = sin(other->heading_rad);
    double half_length_m = 0.5 * other->length_m, half_width_m = 0.5 * other->width_m;
    span along = overlap(other->ahead_m - half_length_m * c,
                         half_length_m * fabs(c) + half_width_m * fabs(s),
                         other->speed_m_s * c - own->speed_m_s, -own->length_m, 0.0);
    span across =
        overlap(other->left_m - half_length_m * s, half_length_m * fabs(s) + half_width_m * fabs(c),
                other->speed_m_s * s, -0.5 * own->width_m, 0.5 * own->width_m);
    double from_s = fmax(fmax(along.from_s, across.from_s), 0.0);
    return from_s < fmin(along.to_s, across.to_s) ? from_s : INFINITY;
}

static const char *step(void *self, void *memory, const crashpulse_view *view,
                        crashpulse_request *request)
{
    const double *parameter = self;
    car *own = memory;
    const crashpulse_object *object;
    size_t count = view->host->look(view, &object);
    double nearest_s = INFINITY;
    for (size_t k = 0; k < count; k++) {
        double time_s = ttc_s(view, &object[k]);
        if (time_s < nearest_s)
            request->target = object[k].id;
        nearest_s = fmin(nearest_s, time_s);
    }
    own->is_braking = nearest_s < parameter[own->is_braking ? RELEASE_TTC_S : TTC_S];
    if (own->is_braking)
        request->acceleration_m_s2 = -parameter[DECELERATION_M_S2];
    return NULL;
}

static const crashpulse_function MY_AEB = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_BRAKES,
    .what = "brakes for what would overlap, straight on",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .car_size = sizeof(car),
    .create = create,
    .step = step,
};

const crashpulse_function *crashpulse_function_entry(void)
{
    return &MY_AEB;
}
