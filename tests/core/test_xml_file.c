/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "core/file.h"
#include "core/xml_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static const char TEXT[] = "<?xml version='1.0'?>\n"
                           "<!DOCTYPE a [<!ENTITY other SYSTEM 'other.xml'>]>\n"
                           "<a>\n<b c='1 &amp; 2'>three<![CDATA[ & four]]></b></a>\n";

typedef struct seen {
    char text[256];
    size_t line_of_b;
} seen;

static cp_status begin(void *context, const cp_xml_element *element, cp_error *error)
{
    seen *s = context;
    (void)error;
    if (strcmp(element->name, "b") == 0) {
        s->line_of_b = element->line;
        strcat(s->text, cp_xml_attribute(element, "c"));
        strcat(s->text, "|");
    }
    return CP_OK;
}

static cp_status take_text(void *context, const char *text, size_t size, cp_error *error)
{
    seen *s = context;
    (void)error;
    strncat(s->text, text, size);
    return CP_OK;
}

static cp_status end(void *context, const char *name, cp_error *error)
{
    seen *s = context;
    (void)error;
    strcat(s->text, "|");
    strcat(s->text, name);
    return CP_OK;
}

static cp_status outside(void *context, const char *name, cp_error *error)
{
    seen *s = context;
    (void)error;
    strcat(s->text, name);
    return CP_OK;
}

static const cp_xml_visitor EVERYTHING = {begin, take_text, end, outside};

static int make_folder(void **state)
{
    static char folder[64];
    snprintf(folder, sizeof folder, "/tmp/crashpulse-test-XXXXXX");
    *state = mkdtemp(folder);
    return *state == NULL || chdir(folder) != 0;
}

static int remove_folder(void **state)
{
    unlink("a.xml");
    unlink("a.xml.gz");
    unlink("half.xml.gz");
    return chdir("/") != 0 || rmdir(*state) != 0;
}

static void a_compressed_file_reads_like_a_plain_one(void **state)
{
    (void)state;
    static const char *const NAME[] = {"a.xml", "a.xml.gz"};
    cp_error error = {0};
    assert_int_equal(cp_file_write("a.xml", TEXT, strlen(TEXT), &error), CP_OK);
    gzFile packed = gzopen("a.xml.gz", "wb");
    assert_int_equal(gzwrite(packed, TEXT, sizeof TEXT - 1), sizeof TEXT - 1);
    assert_int_equal(gzclose(packed), Z_OK);
    for (size_t k = 0; k < 2; k++) {
        seen s = {0};
        assert_int_equal(cp_xml_read_all(NAME[k], "a", &EVERYTHING, &s, &error), CP_OK);
        assert_string_equal(s.text, "other.xml\n1 & 2|three & four|b|a");
        assert_int_equal(s.line_of_b, 4);
        assert_int_equal(cp_xml_read_all(NAME[k], "b", &EVERYTHING, &s, &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "must be <b>, found <a>"));
    }
}

static void a_compressed_file_cut_off_is_named(void **state)
{
    (void)state;
    cp_error error = {0};
    char *content = NULL;
    size_t size = 0;
    gzFile packed = gzopen("a.xml.gz", "wb");
    assert_int_equal(gzwrite(packed, TEXT, sizeof TEXT - 1), sizeof TEXT - 1);
    assert_int_equal(gzclose(packed), Z_OK);
    assert_int_equal(cp_file_read("a.xml.gz", &content, &size, &error), CP_OK);
    assert_int_equal(cp_file_write("half.xml.gz", content, size - 6, &error), CP_OK);
    free(content);
    seen s = {0};
    assert_int_equal(cp_xml_read_all("half.xml.gz", "a", &EVERYTHING, &s, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "half.xml.gz: cannot be read: "));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_compressed_file_reads_like_a_plain_one),
        cmocka_unit_test(a_compressed_file_cut_off_is_named),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
