/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit_pulses.h"

#include "core/file.h"
#include "core/hash.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OPTIONAL_TEXT(key)                                                                         \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_pulse, key, 0,  \
                           CYAML_UNLIMITED)

static const cyaml_schema_value_t CHANNEL_VALUE = {
    CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 0, CYAML_UNLIMITED)};

static const cyaml_schema_field_t PULSE_FIELDS[] = {
    OPTIONAL_TEXT(speed_km_h),
    OPTIONAL_TEXT(offset_mm),
    OPTIONAL_TEXT(angle_deg),
    OPTIONAL_TEXT(file),
    OPTIONAL_TEXT(ev5),
    CYAML_FIELD_SEQUENCE("channels", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_pulse,
                         channels, &CHANNEL_VALUE, 1, CP_PULSE_SENSORS_MAX),
    OPTIONAL_TEXT(until_s),
    OPTIONAL_TEXT(weight),
    CYAML_FIELD_END};

const cyaml_schema_value_t CP_YAML_PULSE_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_yaml_pulse, PULSE_FIELDS)};

// Key path of a field of entry number row.
#define KEY_SIZE 64
static const char *key_of(size_t row, const char *field, char key[KEY_SIZE])
{
    snprintf(key, KEY_SIZE, "pulses[%zu].%s", row, field);
    return key;
}

static cp_status read_numbers(const cp_yaml_file *file, const cp_yaml_pulse *entry, size_t row,
                              cp_pulse_source *source, cp_error *error)
{
    *source = (cp_pulse_source){.speed_km_h = NAN, .until_s = NAN, .weight_1 = 1.0};
    const struct {
        const char *field;
        const char *text;
        double smallest;
        double largest;
        double *value;
    } NUMBERS[] = {{"speed_km_h", entry->speed_km_h, 1.0, 200.0, &source->speed_km_h},
                   {"offset_mm", entry->offset_mm, -3000.0, 3000.0, &source->offset_mm},
                   {"angle_deg", entry->angle_deg, -90.0, 90.0, &source->angle_deg},
                   {"until_s", entry->until_s, 0.01, 1.0, &source->until_s},
                   {"weight", entry->weight, 1e-6, 1e6, &source->weight_1}};
    char key[KEY_SIZE];
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof NUMBERS / sizeof *NUMBERS; k++)
        status = cp_yaml_number(file, key_of(row, NUMBERS[k].field, key), NUMBERS[k].text,
                                NUMBERS[k].smallest, NUMBERS[k].largest, NUMBERS[k].value, error);
    return status;
}

static cp_status read_sensors(const cp_yaml_file *file, const cp_yaml_pulse *entry, size_t row,
                              cp_pulse_source *source, cp_error *error)
{
    char key[KEY_SIZE];
    if ((entry->file == NULL) == (entry->ev5 == NULL))
        return cp_yaml_fail(file, error, key_of(row, "file", key),
                            "either file or ev5 must say where the pulse is");
    if ((entry->ev5 != NULL) != (entry->channels_count > 0))
        return cp_yaml_fail(file, error, key_of(row, "channels", key),
                            "goes with ev5: the numbers of its longitudinal accelerometers");
    for (unsigned k = 0; k < entry->channels_count; k++) {
        double number = 0.0;
        snprintf(key, sizeof key, "pulses[%zu].channels[%u]", row, k);
        cp_status status = cp_yaml_number(file, key, entry->channels[k], 1, 99999, &number, error);
        if (status != CP_OK)
            return status;
        if (number != floor(number))
            return cp_yaml_fail(file, error, key, "must be a whole number, found %s",
                                entry->channels[k]);
        source->sensor[source->sensor_count++] = (int)number;
    }
    return CP_OK;
}

static cp_status load_entry(const cp_yaml_file *file, const cp_yaml_pulse *entry, size_t row,
                            cp_reference_pulse *pulse, cp_error *error)
{
    cp_pulse_source source;
    cp_status status = read_numbers(file, entry, row, &source, error);
    if (status == CP_OK)
        status = read_sensors(file, entry, row, &source, error);
    if (status != CP_OK)
        return status;
    char *path = cp_file_beside(file->path, entry->ev5 != NULL ? entry->ev5 : entry->file);
    source.path = path;
    status = path != NULL ? cp_reference_pulse_load(&source, pulse, error)
                          : cp_fail_memory(error, "reference pulse");
    free(path);
    if (status == CP_BAD_INPUT) {
        char key[KEY_SIZE];
        snprintf(key, sizeof key, "pulses[%zu]", row);
        return cp_error_prefix(error, "%s:%zu: %s: ", file->path, cp_yaml_line_of(file, key), key);
    }
    return status;
}

// What an OLC table would hold: conditions and OLC; the hash of all pulses' hashes.
static cp_status derive_reference(cp_fit *fit, cp_error *error)
{
    size_t count = fit->pulse_count;
    fit->reference.cases = calloc(count, sizeof *fit->reference.cases);
    char *hashes = malloc(count * CP_HASH_TEXT_SIZE);
    cp_status status = CP_OK;
    if (fit->reference.cases == NULL || hashes == NULL)
        status = cp_fail_memory(error, "reference pulses");
    for (size_t k = 0; status == CP_OK && k < count; k++) {
        fit->reference.cases[k] = fit->pulses[k].condition;
        memcpy(hashes + k * (CP_HASH_TEXT_SIZE - 1), fit->pulses[k].hash, CP_HASH_TEXT_SIZE);
    }
    if (status == CP_OK) {
        fit->reference.count = count;
        cp_hash_bytes(hashes, count * (CP_HASH_TEXT_SIZE - 1), fit->reference.hash);
    }
    free(hashes);
    return status;
}

cp_status cp_fit_pulses_load(const cp_yaml_file *file, const cp_yaml_pulse *entries, size_t count,
                             cp_fit *fit, cp_error *error)
{
    fit->pulses = calloc(count, sizeof *fit->pulses);
    if (fit->pulses == NULL)
        return cp_fail_memory(error, "reference pulses");
    cp_status status = CP_OK;
    for (size_t row = 0; status == CP_OK && row < count; row++) {
        status = load_entry(file, &entries[row], row, &fit->pulses[row], error);
        fit->pulse_count += status == CP_OK;
    }
    return status == CP_OK ? derive_reference(fit, error) : status;
}
