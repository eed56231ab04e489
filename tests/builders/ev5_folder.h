/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_EV5_FOLDER_H
#define BUILDERS_EV5_FOLDER_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A made-up crash test in NHTSA's EV5 form, in a folder of its own: t1.EV5, a car of 1500 kg at
 * 36 km/h; curve 7, an accelerometer at 1 kHz from -50 ms on that rests at 0.5 g and reads -9.5 g
 * from time 0 on; curve 10, one that rests at 0 and reads -20 g; curve 1012, a displacement of 250
 * mm throughout; curve 9, without data. Include after cmocka.h. */
enum { EV5_PRE = 50, EV5_POST = 100 };

typedef struct ev5_folder {
    char path[64];
} ev5_folder;

static const char EV5_TEXT[] =
    "# made up\n"
    "----- EV5 -----\n"
    "----- TEST -----\n"
    "V5|MADE-UP TEST|NONE|01/JAN/2020|LAB|C1|REF1|NCA|VTB|CON|DRY|22|OTH|OTH|36.0|0|0|0|3|DAS\n"
    "----- VEHICLE -----\n"
    "1|16|03|2018|M1|4S|VIN|4CIF|2.5|AF|1500|1400|2700|4500|1800|1200|UN|UNK|P|"
    "|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15|16|17|18|19|20|21|36.0|0|0|DE\n"
    "----- OCCUPANT -----\n"
    "1|01|H3|0|M|0\n"
    "----- INSTRUMENTATION -----\n"
    "1|7|AC|NA|FLLR|XG|SEC|G'S|2800|MFG|12/APR/2017|800|21|36.0|-50|99|1000|AM|P|LEFT SILL X\n"
    "1|1012|DS|NA|OTHR|NA|SEC|MM|2800|MFG|12/APR/2017|800|21|0.0|-50|99|1000|AM|P|CRUSH\n"
    "1|9|AC|NA|OTHR|XG|SEC|G'S|2800|MFG|12/APR/2017|800|21|0.0|-50|99|1000|NO|P|NOT INSTALLED\n"
    "1|10|AC|NA|FLRR|XG|SEC|G'S|2800|MFG|12/APR/2017|800|21|36.0|-50|99|1000|AM|P|RIGHT SILL X\n"
    "----- END -----\n";

static inline void ev5_folder_write(const ev5_folder *folder, const char *name, const char *text)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder->path, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static inline void ev5_folder_remove(const ev5_folder *folder, const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder->path, name);
    assert_int_equal(unlink(path), 0);
}

static inline void ev5_folder_write_curve(const ev5_folder *folder, const char *name, double before,
                                          double after)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder->path, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int k = -EV5_PRE; k < EV5_POST; k++)
        fprintf(file, "%.6f\t%.6f\n", 1e-3 * k, k < 0 ? before : after);
    assert_int_equal(fclose(file), 0);
}

static inline ev5_folder ev5_folder_open(void)
{
    ev5_folder folder = {.path = "/tmp/ev5_XXXXXX"};
    assert_non_null(mkdtemp(folder.path));
    ev5_folder_write(&folder, "t1.EV5", EV5_TEXT);
    ev5_folder_write_curve(&folder, "t1.007", 0.5, -9.5);
    ev5_folder_write_curve(&folder, "t1.010", 0.0, -20.0);
    ev5_folder_write_curve(&folder, "t1.1012", 250.0, 250.0);
    return folder;
}

/* The EV5 file with its first from replaced by to. */
static inline void ev5_folder_replace(const ev5_folder *folder, const char *from, const char *to)
{
    char text[sizeof EV5_TEXT + 256];
    const char *at = strstr(EV5_TEXT, from);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - EV5_TEXT), EV5_TEXT, to, at + strlen(from));
    ev5_folder_write(folder, "t1.EV5", text);
}

static inline void ev5_folder_close(const ev5_folder *folder)
{
    DIR *directory = opendir(folder->path);
    assert_non_null(directory);
    for (struct dirent *entry = readdir(directory); entry != NULL; entry = readdir(directory))
        if (entry->d_name[0] != '.')
            ev5_folder_remove(folder, entry->d_name);
    closedir(directory);
    assert_int_equal(rmdir(folder->path), 0);
}

#endif
