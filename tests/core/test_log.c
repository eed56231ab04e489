/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/log.h"

#include <jansson.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// What goes to stderr meanwhile.
static void listen_to(void (*speak)(void), char text[4096])
{
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(stderr);
    int own = dup(STDERR_FILENO);
    dup2(fileno(file), STDERR_FILENO);
    speak();
    fflush(stderr);
    dup2(own, STDERR_FILENO);
    close(own);
    rewind(file);
    size_t size = fread(text, 1, 4095, file);
    text[size] = '\0';
    fclose(file);
}

static void say_everything(void)
{
    cp_log_detail("d%d", 1);
    cp_log_info("i%d", 2);
    cp_log_warning("w \"%s\"", "\x1b[31m");
    cp_log_error("two\nlines");
    cp_log_pass_on("crashpulse: warning: of a worker\n");
}

static void levels_choose_what_is_said(void **state)
{
    (void)state;
    char text[4096];
    unsetenv(CP_LOG_FORMAT_VARIABLE);
    unsetenv(CP_LOG_VARIABLE);
    listen_to(say_everything, text);
    assert_string_equal(text, "crashpulse: i2\n"
                              "crashpulse: warning: w \"\\x1b[31m\"\n"
                              "crashpulse: error: two\n    lines\n"
                              "crashpulse: warning: of a worker\n");
    setenv(CP_LOG_VARIABLE, "quiet", 1);
    listen_to(say_everything, text);
    assert_null(strstr(text, "i2"));
    assert_non_null(strstr(text, "of a worker"));
    setenv(CP_LOG_VARIABLE, "verbose", 1);
    listen_to(say_everything, text);
    assert_non_null(strstr(text, "crashpulse: d1\ncrashpulse: i2\n"));
    unsetenv(CP_LOG_VARIABLE);
}

static void json_has_an_object_a_line(void **state)
{
    (void)state;
    static const char *const LEVEL[] = {"info", "warning", "error", "warning"};
    static const char *const MESSAGE[] = {"i2", "w \"\\x1b[31m\"", "two\nlines", "of a worker"};
    char text[4096];
    setenv(CP_LOG_FORMAT_VARIABLE, "json", 1);
    listen_to(say_everything, text);
    unsetenv(CP_LOG_FORMAT_VARIABLE);
    char *line = strtok(text, "\n");
    for (size_t k = 0; k < 4; k++, line = strtok(NULL, "\n")) {
        assert_non_null(line);
        json_t *object = json_loads(line, 0, NULL);
        assert_non_null(object);
        assert_string_equal(json_string_value(json_object_get(object, "level")), LEVEL[k]);
        assert_string_equal(json_string_value(json_object_get(object, "message")), MESSAGE[k]);
        assert_int_equal(strlen(json_string_value(json_object_get(object, "time"))), 20);
        json_decref(object);
    }
    assert_null(line);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_choose_what_is_said),
        cmocka_unit_test(json_has_an_object_a_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
