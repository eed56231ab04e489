/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/conditions.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static char *written(const cp_conditions *c, size_t treatments)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    cp_conditions_write(out, c, treatments);
    assert_int_equal(fclose(out), 0);
    return text;
}

// What holds for all is said once without a name, what holds for some once with theirs.
static void the_same_is_said_once(void **state)
{
    (void)state;
    cp_conditions c = {0};
    const char *const name[] = {"aeb", "elk", "isa"};
    for (size_t k = 0; k < 3; k++) {
        cp_conditions_add(&c, name[k], "Over 20 seeds", NULL);
        if (k > 0)
            cp_conditions_add(&c, name[k], "By counts", NULL);
        cp_conditions_add(&c, name[k], "At least", k == 1 ? "0.2" : "0.1");
    }
    assert_false(c.failed);
    char *text = written(&c, 3);
    assert_string_equal(text, "Over 20 seeds. At least 0.1 (aeb), 0.2 (elk), 0.1 (isa). "
                              "elk, isa: By counts. ");
    free(text);
    cp_conditions_destroy(&c);
}

// Alone, a treatment needs no name.
static void one_treatment_is_not_named(void **state)
{
    (void)state;
    cp_conditions c = {0};
    cp_condition_draft d;
    assert_true(cp_condition_begin(&d, &c));
    fputs("0.1 to 2", d.out);
    cp_condition_end(&d, &c, "aeb", "Anything from");
    assert_true(cp_condition_begin(&d, &c));
    cp_condition_end(&d, &c, "aeb", NULL); // nothing written: no condition
    assert_true(cp_condition_begin(&d, &c));
    fprintf(d.out, "Over %d seeds", 20);
    cp_condition_end(&d, &c, "aeb", NULL);
    char *text = written(&c, 1);
    assert_string_equal(text, "Anything from 0.1 to 2. Over 20 seeds. ");
    free(text);
    cp_conditions_destroy(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_is_said_once),
        cmocka_unit_test(one_treatment_is_not_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
