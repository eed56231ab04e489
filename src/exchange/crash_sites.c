/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/crash_sites.h"

#include "core/safe_text.h"
#include "core/units.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double RED_FROM_G = 40.0;

// Larger OLC of the two; NAN: none.
static double olc_g(const cp_selected_crash *crash)
{
    return fmax(crash->vehicle[0].olc_g, crash->vehicle[1].olc_g);
}

// ---- SUMO ----------------------------------------------------------------------------------

// Text within an attribute. What is no character of XML is shown as on a terminal.
static void write_attribute(FILE *file, const char *text)
{
    char *plain = cp_text_copy_plain(text);
    for (const char *c = plain != NULL ? plain : ""; *c != '\0'; c++)
        switch (*c) {
        case '&':
            fputs("&amp;", file);
            break;
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        default:
            fputc(*c, file);
        }
    free(plain);
}

static void write_text_parameter(FILE *file, const char *key, const char *value)
{
    fprintf(file, "        <param key=\"%s\" value=\"", key);
    write_attribute(file, value);
    fputs("\"/>\n", file);
}

static void write_parameter(FILE *file, const char *key, double value, int digits)
{
    if (isfinite(value))
        fprintf(file, "        <param key=\"%s\" value=\"%.*f\"/>\n", key, digits, value);
}

void cp_sumo_poi_begin(FILE *file)
{
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<additional xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
          "xsi:noNamespaceSchemaLocation=\"http://sumo.dlr.de/xsd/additional_file.xsd\">\n",
          file);
}

void cp_sumo_poi_write(FILE *file, const cp_selected_crash *crash)
{
    // From yellow to red.
    double share = fmin(1.0, fmax(0.0, olc_g(crash) / RED_FROM_G));
    int green = (int)(255.0 * (1.0 - (isnan(olc_g(crash)) ? 0.0 : share)) + 0.5);
    fprintf(file,
            "    <poi id=\"crash.%lld\" type=\"crash\" color=\"255,%d,0\" layer=\"200\" x=\"%.3f\" "
            "y=\"%.3f\" width=\"3\" height=\"3\">\n",
            (long long)crash->id, green, crash->x_m, crash->y_m);
    write_text_parameter(file, "scenario", crash->scenario);
    write_text_parameter(file, "variant", crash->variant);
    if (crash->treatment[0] != '\0')
        write_text_parameter(file, "treatment", crash->treatment);
    fprintf(file, "        <param key=\"replication\" value=\"%lld\"/>\n",
            (long long)crash->replication);
    write_parameter(file, "time_s", crash->time_s, 3);
    write_text_parameter(file, "crash_type", crash->crash_type);
    write_parameter(file, "closing_speed_km_h", cp_km_h_from_m_s(crash->closing_speed_m_s), 2);
    write_text_parameter(file, "vehicle_a", crash->vehicle[0].sumo_id);
    write_text_parameter(file, "vehicle_b", crash->vehicle[1].sumo_id);
    write_parameter(file, "olc_a_g", crash->vehicle[0].olc_g, 3);
    write_parameter(file, "olc_b_g", crash->vehicle[1].olc_g, 3);
    write_text_parameter(file, "validity", crash->validity);
    fputs("    </poi>\n", file);
}

void cp_sumo_poi_end(FILE *file)
{
    fputs("</additional>\n", file);
}

// ---- GeoJSON -------------------------------------------------------------------------------

static json_t *real_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

// Any text; what is no UTF-8 as on a terminal.
static json_t *text_json(const char *text)
{
    json_t *value = json_string(text);
    if (value != NULL)
        return value;
    char *plain = cp_text_copy_plain(text);
    value = plain != NULL ? json_string(plain) : NULL;
    free(plain);
    return value;
}

static json_t *properties_json(const cp_selected_crash *crash)
{
    static const char *const ROLE[2] = {"a", "b"};
    json_t *all =
        json_pack("{s:I, s:o, s:o, s:o, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "crash_id",
                  (json_int_t)crash->id, "scenario", text_json(crash->scenario), "variant",
                  text_json(crash->variant), "treatment",
                  crash->treatment[0] != '\0' ? text_json(crash->treatment) : json_null(),
                  "replication", (json_int_t)crash->replication, "time_s", real_json(crash->time_s),
                  "crash_type", text_json(crash->crash_type), "closing_speed_m_s",
                  real_json(crash->closing_speed_m_s), "lateral_offset_m",
                  real_json(crash->lateral_offset_m), "angle_rad", real_json(crash->angle_rad),
                  "overlap_1", real_json(crash->overlap_1), "validity", text_json(crash->validity));
    for (int v = 0; v < 2; v++) {
        const cp_selected_vehicle *own = &crash->vehicle[v];
        const struct {
            const char *name;
            json_t *value;
        } PART[] = {{"sumo_id", text_json(own->sumo_id)},
                    {"vehicle_model", text_json(own->vehicle_model)},
                    {"contact_side", text_json(own->contact_side)},
                    {"at_fault", json_boolean(own->at_fault)},
                    {"speed_m_s", real_json(own->speed_m_s)},
                    {"delta_v_m_s", real_json(own->delta_v_m_s)},
                    {"olc_g", real_json(own->olc_g)},
                    {"olc_status", text_json(own->olc_status)}};
        for (size_t k = 0; k < sizeof PART / sizeof *PART; k++) {
            char name[48];
            snprintf(name, sizeof name, "%s_%s", PART[k].name, ROLE[v]);
            json_object_set_new(all, name, PART[k].value);
        }
    }
    return all;
}

void cp_geojson_begin(FILE *file, const cp_network_projection *projection)
{
    fputs("{\"type\": \"FeatureCollection\",\n", file);
    if (projection == NULL)
        fputs("\"coordinates\": \"metres of the SUMO network, not degrees\",\n", file);
    fputs("\"features\": [", file);
}

cp_status cp_geojson_write(FILE *file, const cp_selected_crash *crash,
                           const cp_network_projection *projection, size_t number, cp_error *error)
{
    cp_vec2 place = {crash->x_m, crash->y_m};
    if (projection != NULL) {
        cp_status status = cp_network_projection_degrees(projection, place, &place, error);
        if (status != CP_OK)
            return status;
    }
    json_t *feature = json_pack("{s:s, s:I, s:{s:s, s:[f, f]}, s:o}", "type", "Feature", "id",
                                (json_int_t)crash->id, "geometry", "type", "Point", "coordinates",
                                place.x, place.y, "properties", properties_json(crash));
    if (feature == NULL)
        return cp_fail_memory(error, "a crash site");
    fputs(number > 0 ? ",\n" : "\n", file);
    // 12 digits: a tenth of a millimetre on the earth.
    int failed = json_dumpf(feature, file, JSON_COMPACT | JSON_REAL_PRECISION(12));
    json_decref(feature);
    return failed == 0 ? CP_OK : cp_fail(error, CP_IO_FAILED, "writing a crash site failed");
}

void cp_geojson_end(FILE *file)
{
    fputs("\n]}\n", file);
}
