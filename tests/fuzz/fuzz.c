/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fuzz.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const fuzz_target FUZZ_TARGET[] = {
    {"vehicle", fuzz_vehicle, 16384},
    {"study", fuzz_study, 8192},
    {"fit", fuzz_fit, 8192},
    {"suite", fuzz_suite, 8192},
    {"reference", fuzz_reference, 4096},
    {"configurations", fuzz_configurations, 4096},
    {"pulse_csv", fuzz_pulse_csv, 8192},
    {"table", fuzz_table, 4096},
    {"ev5", fuzz_ev5, 8192},
    {"collisions", fuzz_collisions, 4096},
    {"fcd", fuzz_fcd, 8192},
    {"types", fuzz_types, 4096},
    {"sumocfg", fuzz_sumocfg, 4096},
    {"codec", fuzz_codec, 4096},
    {"sql", fuzz_sql, 4096},
    {"rows", fuzz_rows, 512},
    {"iso_mme", fuzz_iso_mme, 8192},
    {"lsdyna", fuzz_lsdyna, 8192},
    {"pulse_file", fuzz_pulse_file, 8192},
    {"location", fuzz_location, 2048},
};
const size_t FUZZ_TARGET_COUNT = sizeof FUZZ_TARGET / sizeof *FUZZ_TARGET;

const fuzz_target *fuzz_find(const char *name)
{
    for (size_t k = 0; name != NULL && k < FUZZ_TARGET_COUNT; k++)
        if (strcmp(FUZZ_TARGET[k].name, name) == 0)
            return &FUZZ_TARGET[k];
    fprintf(stderr, "no target '%s'; there are:", name != NULL ? name : "");
    for (size_t k = 0; k < FUZZ_TARGET_COUNT; k++)
        fprintf(stderr, " %s", FUZZ_TARGET[k].name);
    fprintf(stderr, "\n");
    exit(2);
}

// ---- the folder ----------------------------------------------------------------------------

static char folder[4096];

static const struct {
    const char *name, *text;
} FILES[] = {
    {"car.yaml", "vehicle: car\nparameters: []\n"},
    {"reference.csv",
     "speed_kmh,offset_mm,angle_deg,olc_fe_g\n56,0,0,23.9\n40,0,0,15.0\n25,0,0,9.0\n"},
    {"pulse.csv", "time_s,ax_m_s2,vx_m_s\n0,0,10\n0.001,-100,9.9\n0.002,-100,9.8\n"
                  "0.003,-100,9.7\n0.004,-100,9.6\n"},
    {"table.csv", "name,value\none,1\ntwo,2\n"},
    {"net.sumocfg", "<configuration><input><net-file value=\"net.net.xml\"/>"
                    "<route-files value=\"net.rou.xml\"/></input></configuration>\n"},
    {"net.net.xml", "<net version=\"1.9\"/>\n"},
    {"net.rou.xml", "<routes/>\n"},
    {"collisions.xml",
     "<collisions>\n<collision time=\"4.90\" type=\"frontal\" lane=\"e_0\" pos=\"60\" "
     "collider=\"a\" victim=\"b\" colliderType=\"car\" victimType=\"car\" colliderSpeed=\"10\" "
     "victimSpeed=\"10\"/>\n</collisions>\n"},
};

void fuzz_write(const char *name, const void *data, size_t size)
{
    FILE *file = fopen(name, "wb");
    if (file == NULL || fwrite(data, 1, size, file) != size || fclose(file) != 0) {
        perror(name);
        _exit(2);
    }
}

static void remove_folder(void)
{
    char command[4200];
    if (chdir("/") != 0)
        return;
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command) != 0)
        fprintf(stderr, "%s: is left over\n", folder);
}

void fuzz_begin(void)
{
    const char *where = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/crashpulse-fuzz-XXXXXX", where != NULL ? where : "/tmp");
    if (mkdtemp(folder) == NULL || chdir(folder) != 0) {
        perror(folder);
        exit(2);
    }
    atexit(remove_folder);
    for (size_t k = 0; k < sizeof FILES / sizeof *FILES; k++)
        fuzz_write(FILES[k].name, FILES[k].text, strlen(FILES[k].text));
}

// ---- judging -------------------------------------------------------------------------------

void fuzz_must(int holds, const char *what)
{
    if (holds)
        return;
    printf("FUZZ: %s\n", what);
    fflush(stdout);
    abort();
}

static bool has_null; // the input itself says "(null)"
size_t fuzz_read_well;

void fuzz_run(const fuzz_target *target, const uint8_t *data, size_t size)
{
    has_null = memmem(data, size, "(null)", 6) != NULL;
    target->run(data, size);
}

void fuzz_judge(cp_status status, const cp_error *error)
{
    fuzz_read_well += status == CP_OK;
    if (status == CP_OK)
        return;
    fuzz_must(status == CP_BAD_INPUT || status == CP_NO_MEMORY, cp_status_text(status));
    fuzz_must(error->status == status, "the error has another status");
    fuzz_must(error->text[0] != '\0', "an error without words");
    fuzz_must(has_null || strstr(error->text, "(null)") == NULL, error->text);
}

const uint8_t *fuzz_part(const uint8_t *data, size_t size, int number, size_t *part_size)
{
    static const char LINE[] = "\n=====\n";
    const uint8_t *begin = data, *end = data + size;
    for (;; number--) {
        const uint8_t *next = begin < end ? memmem(begin, (size_t)(end - begin), LINE, 7) : NULL;
        *part_size = (size_t)((next != NULL ? next + 1 : end) - begin);
        if (number == 0)
            return begin;
        begin = next != NULL ? next + 7 : end;
    }
}

// ---- libFuzzer -----------------------------------------------------------------------------

/* The target is the one that the variable FUZZ_TARGET names. */
int LLVMFuzzerInitialize(int *count, char ***words);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const fuzz_target *chosen;

int LLVMFuzzerInitialize(int *count, char ***words)
{
    (void)count, (void)words;
    chosen = fuzz_find(getenv("FUZZ_TARGET"));
    fuzz_begin();
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size <= chosen->size_max)
        fuzz_run(chosen, data, size);
    return 0;
}
