/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/store_file.h"

#include "fixture.h"

#include <stdio.h>
#include <sys/stat.h>

static void write_header(const char *path, int version, size_t size)
{
    unsigned char header[100] = "SQLite format 3";
    header[18] = header[19] = (unsigned char)version;
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(header, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void header_tells_of_a_log(void **state)
{
    const fixture *f = *state;
    assert_false(cp_store_file_has_log_mode(f->db));
    write_header(f->db, 1, 100);
    assert_false(cp_store_file_has_log_mode(f->db));
    write_header(f->db, 2, 100);
    assert_true(cp_store_file_has_log_mode(f->db));
    write_header(f->db, 2, 19);
    assert_false(cp_store_file_has_log_mode(f->db));
}

// What may be written is opened as ever; tests/store/test_travel.py has what may not.
static void who_may_write_reads_plainly(void **state)
{
    const fixture *f = *state;
    write_header(f->db, 2, 100);
    assert_int_equal(cp_store_file_reading(f->db), CP_STORE_READING_PLAIN);
    assert_int_equal(cp_store_file_reading("not there/study.db"), CP_STORE_READING_PLAIN);
}

static void network_file_systems_have_names(void **state)
{
    (void)state;
    assert_string_equal(cp_network_file_system(0x6969), "NFS");
    assert_string_equal(cp_network_file_system(0xff534d42), "CIFS");
    assert_string_equal(cp_network_file_system(0x0bd00bd0), "Lustre");
    assert_null(cp_network_file_system(0xef53));     // ext4
    assert_null(cp_network_file_system(0x58465342)); // XFS
    assert_null(cp_network_file_system(0x01021994)); // tmpfs
    assert_null(cp_network_file_system(0x794c7630)); // overlay
    assert_null(cp_store_file_network("/proc/self/stat"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(header_tells_of_a_log, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(who_may_write_reads_plainly, fixture_begin, fixture_end),
        cmocka_unit_test(network_file_systems_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
