/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fuzz_blind TARGET SEEDS [--cases N] [--seed S] [--first K]: a target with every file of the
 * folder SEEDS, then with N of them changed at random; blind, where libFuzzer (preset fuzz) follows
 * which branches are taken. Case K alone can be repeated with --first K --cases 1. A case that ends
 * the process is named. The last line counts. */
#include "fuzz.h"

#include "core/file.h"
#include "core/progress.h"
#include "core/rng.h"

#include <glob.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SEEDS_MAX = 64, INPUT_MAX = 1 << 16, CHANGES_MAX = 8 };

typedef struct seed_file {
    char *content;
    size_t size;
} seed_file;

static seed_file seeds[SEEDS_MAX];
static size_t seed_count;
static volatile sig_atomic_t case_number = -1;
static char case_text[256];

// ---- changing ------------------------------------------------------------------------------

// What readers of text and numbers stumble over.
static const char *const WORDS[] = {"nan",
                                    "inf",
                                    "-1",
                                    "0",
                                    "1e308",
                                    "1e-320",
                                    "99999999999999999999",
                                    "0x10",
                                    "''",
                                    "\"",
                                    "&a ",
                                    "*a",
                                    ": ",
                                    "- ",
                                    "[",
                                    "{",
                                    "\n",
                                    "\t",
                                    "#",
                                    "---\n",
                                    "<",
                                    "/>",
                                    "]]>",
                                    "&lt;",
                                    "<!--",
                                    "=",
                                    "|",
                                    ",",
                                    "\xff",
                                    "\xef\xbb\xbf",
                                    "%s%n",
                                    "../",
                                    "\r\n",
                                    "!!",
                                    "\n=====\n",
                                    "-0",
                                    "1e9",
                                    "~",
                                    "\x1b[",
                                    "\xc0\x80"};

typedef struct input {
    uint8_t data[INPUT_MAX];
    size_t size;
} input;

static void insert(input *in, size_t at, const void *bytes, size_t size)
{
    if (in->size + size > INPUT_MAX)
        return;
    memmove(in->data + at + size, in->data + at, in->size - at);
    memcpy(in->data + at, bytes, size);
    in->size += size;
}

static void cut(input *in, size_t at, size_t size)
{
    size = size < in->size - at ? size : in->size - at;
    memmove(in->data + at, in->data + at + size, in->size - at - size);
    in->size -= size;
}

static void change(input *in, cp_rng_key key)
{
    uint8_t piece[64];
    const char *word = WORDS[cp_rng_bits(key, 0) % (sizeof WORDS / sizeof *WORDS)];
    const seed_file *other = &seeds[cp_rng_bits(key, 1) % seed_count];
    size_t at = in->size > 0 ? cp_rng_bits(key, 2) % in->size : 0;
    size_t length = 1 + cp_rng_bits(key, 3) % sizeof piece;
    size_t from = other->size > 0 ? cp_rng_bits(key, 4) % other->size : 0;
    length = length < other->size - from ? length : other->size - from;
    memcpy(piece, other->content + from, length);
    switch (cp_rng_bits(key, 5) % 25 / 4) {
    case 0:
        if (in->size > 0)
            in->data[at] ^= (uint8_t)(1u << cp_rng_bits(key, 6) % 8);
        break;
    case 1:
        if (in->size > 0)
            in->data[at] = (uint8_t)cp_rng_bits(key, 6);
        break;
    case 2:
        cut(in, at, length);
        break;
    case 3: // over what stands there
        cut(in, at, strlen(word));
        insert(in, at, word, strlen(word));
        break;
    case 4:
        insert(in, at, word, strlen(word));
        break;
    case 5:
        insert(in, at, piece, length);
        break;
    default:
        in->size = at; // cut off
        break;
    }
}

static void make_case(const fuzz_target *target, cp_rng_key key, input *in)
{
    const seed_file *from = &seeds[cp_rng_bits(cp_rng_key_text(key, "from"), 0) % seed_count];
    in->size = from->size < target->size_max ? from->size : target->size_max;
    memcpy(in->data, from->content, in->size);
    // Half of them with one change only, which many readers take as well.
    uint64_t bits = cp_rng_bits(cp_rng_key_text(key, "changes"), 0);
    size_t changes = bits % 2 == 0 ? 1 : 1 + bits / 2 % CHANGES_MAX;
    for (size_t k = 0; k < changes; k++)
        change(in, cp_rng_key_number(key, k));
    if (in->size > target->size_max)
        in->size = target->size_max;
}

// ---- running -------------------------------------------------------------------------------

static void tell_case(int number)
{
    char text[512];
    int length = snprintf(text, sizeof text, "%s: case %ld ended by signal %d\n", case_text,
                          (long)case_number, number);
    if (write(STDOUT_FILENO, text, (size_t)length) < 0)
        _exit(99);
    signal(number, SIG_DFL);
    raise(number);
}

static void load_seeds(const char *folder)
{
    char pattern[4096];
    glob_t files;
    cp_error error = {0};
    snprintf(pattern, sizeof pattern, "%s/*", folder);
    if (glob(pattern, 0, NULL, &files) == 0)
        for (size_t k = 0; k < files.gl_pathc && seed_count < SEEDS_MAX; k++, seed_count++)
            if (cp_file_read(files.gl_pathv[k], &seeds[seed_count].content, &seeds[seed_count].size,
                             &error) != CP_OK) {
                fprintf(stderr, "%s\n", error.text);
                exit(2);
            }
    globfree(&files);
    if (seed_count == 0 || seeds[0].size > INPUT_MAX) {
        fprintf(stderr, "%s: no seeds\n", folder);
        exit(2);
    }
}

// A buffer of just the size, so that a sanitizer sees what is read behind it.
static void run_exactly(const fuzz_target *target, const void *data, size_t size)
{
    uint8_t *copy = malloc(size > 0 ? size : 1);
    fuzz_must(copy != NULL, "no memory");
    memcpy(copy, data, size);
    fuzz_run(target, copy, size);
    free(copy);
}

int main(int argc, char **argv)
{
    uint64_t cases = 1000, seed = 20, first = 0;
    if (argc < 3) {
        fprintf(stderr, "usage: fuzz_blind TARGET SEEDS [--cases N] [--seed S] [--first K]\n");
        return 2;
    }
    for (int k = 3; k + 1 < argc; k += 2) {
        uint64_t *value = strcmp(argv[k], "--cases") == 0  ? &cases
                          : strcmp(argv[k], "--seed") == 0 ? &seed
                                                           : &first;
        *value = strtoull(argv[k + 1], NULL, 10);
    }
    const fuzz_target *target = fuzz_find(argv[1]);
    load_seeds(argv[2]);
    snprintf(case_text, sizeof case_text, "%s, seed %" PRIu64, target->name, seed);
    const int deadly[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGALRM};
    for (size_t k = 0; k < sizeof deadly / sizeof *deadly; k++)
        signal(deadly[k], tell_case);
    fuzz_begin();
    if (freopen("/dev/null", "w", stderr) == NULL) // warnings by the thousand
        return 2;

    double started_s = cp_clock_s();
    for (size_t k = 0; k < seed_count; k++)
        run_exactly(target, seeds[k].content, seeds[k].size);
    size_t seeds_read_well = fuzz_read_well;
    input *in = malloc(sizeof *in);
    fuzz_must(in != NULL, "no memory");
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(seed), target->name);
    for (uint64_t k = first; k < first + cases; k++) {
        case_number = (sig_atomic_t)k;
        alarm(60); // none takes a second
        make_case(target, cp_rng_key_number(key, k), in);
        run_exactly(target, in->data, in->size);
    }
    alarm(0);
    printf("%s: %zu seeds, %zu parts of them read well; %" PRIu64 " cases, %zu likewise; %.1f s\n",
           case_text, seed_count, seeds_read_well, cases, fuzz_read_well - seeds_read_well,
           cp_clock_s() - started_s);
    free(in);
    for (size_t k = 0; k < seed_count; k++)
        free(seeds[k].content);
    return 0;
}
