#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "base/report.h"
#include "base/threads.h"

static void places_are_spelt_as_paths(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    kiln_where root = where_root("car.glb"), materials = where_item(&root, "materials", 4),
               pbr = where_key(&materials, "pbrMetallicRoughness"), texture = where_key(&pbr, "baseColorTexture");
    assert_false(report_error(report, KILN_CODE_REFERENCE, &texture, "export again", "texture %d does not exist", 12));
    report_error(report, KILN_CODE_FILE_MISSING, &root, NULL, "gone");
    report_error(report, KILN_CODE_USAGE, NULL, NULL, "nowhere");
    kiln_message m = kiln_report_message(report, 0);
    assert_string_equal(m.where, "car.glb: materials[4].pbrMetallicRoughness.baseColorTexture");
    assert_string_equal(m.what, "texture 12 does not exist");
    assert_string_equal(m.remedy, "export again");
    assert_true(m.severity == KILN_ERROR && m.code == KILN_CODE_REFERENCE && m.count == 1);
    assert_string_equal(kiln_report_message(report, 1).where, "car.glb");
    assert_string_equal(kiln_report_message(report, 1).remedy, "");
    assert_string_equal(kiln_report_message(report, 2).where, "");
    kiln_report_destroy(report);
}

static void equal_messages_are_counted(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    kiln_where a = where_root("a"), b = where_root("b");
    for (int i = 0; i < 10; i++) report_warning(report, KILN_CODE_IGNORED, i ? &b : &a, NULL, "points are left out");
    report_warning(report, KILN_CODE_GEOMETRY, &a, NULL, "points are left out");
    report_note(report, KILN_CODE_IGNORED, &a, NULL, "points are left out");
    assert_int_equal(kiln_report_size(report), 3);
    assert_int_equal(kiln_report_message(report, 0).count, 10);
    assert_string_equal(kiln_report_message(report, 0).where, "a");
    assert_int_equal(kiln_report_count(report, KILN_WARNING), 11);
    assert_int_equal(kiln_report_count(report, KILN_NOTE), 1);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 0);
    kiln_report_destroy(report);
}

static void the_first_error_decides_the_exit_code(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    assert_int_equal(kiln_report_exit_code(report), 0);
    report_warning(report, KILN_CODE_OUTPUT, NULL, NULL, "a warning");
    assert_int_equal(kiln_report_exit_code(report), 0);
    report_error(report, KILN_CODE_SYNTAX, NULL, NULL, "first");
    report_error(report, KILN_CODE_USAGE, NULL, NULL, "second");
    assert_int_equal(kiln_report_exit_code(report), 3);
    kiln_report_clear(report);
    assert_true(kiln_report_size(report) == 0 && kiln_report_exit_code(report) == 0);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 0);
    assert_false(report_no_memory(report, "testing"));
    assert_int_equal(kiln_report_exit_code(report), 1);
    assert_string_equal(kiln_report_message(report, 0).what, "out of memory while testing");
    kiln_report_destroy(report);
    kiln_report_destroy(NULL);
}

static void every_code_has_a_name_and_an_exit_class(void **state) {
    (void)state;
    for (int code = 0; code < KILN_CODE_COUNT; code++) {
        const char *name = kiln_code_name((kiln_code)code);
        assert_non_null(name);
        for (int other = 0; other < code; other++) assert_string_not_equal(name, kiln_code_name((kiln_code)other));
        kiln_report *report = kiln_report_create();
        report_error(report, (kiln_code)code, NULL, NULL, "x");
        int exit_code = kiln_report_exit_code(report);
        assert_true(exit_code == 1 || exit_code == 2 || exit_code == 3 || exit_code == 75 || exit_code == 130);
        kiln_report_destroy(report);
    }
}

/* A file that is wrong in a million places takes neither a million messages nor quadratic time, and its warnings do
 * not hide the error. */
static void floods_are_bounded(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    for (int i = 0; i < 20000; i++) report_warning(report, KILN_CODE_IGNORED, NULL, NULL, "warning %d", i);
    assert_int_equal(kiln_report_size(report), 1000);
    for (int i = 0; i < 20000; i++) report_error(report, KILN_CODE_RANGE, NULL, NULL, "error %d", i);
    assert_int_equal(kiln_report_size(report), 2000);
    assert_string_equal(kiln_report_message(report, 1000).what, "error 0");
    assert_int_equal(kiln_report_count(report, KILN_WARNING), 20000);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 20000);
    kiln_report_destroy(report);
}

static void add_some(void *context, size_t item, uint32_t thread) {
    (void)thread;
    report_warning(context, KILN_CODE_IGNORED, NULL, NULL, "kind %d", (int)(item % 10));
}

static void threads_may_share_one(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    threads_for(7, 200000, add_some, report);
    assert_int_equal(kiln_report_size(report), 10);
    assert_int_equal(kiln_report_count(report, KILN_WARNING), 200000);
    for (size_t i = 0; i < 10; i++) assert_int_equal(kiln_report_message(report, i).count, 20000);
    kiln_report_destroy(report);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_spelt_as_paths),
        cmocka_unit_test(equal_messages_are_counted),
        cmocka_unit_test(the_first_error_decides_the_exit_code),
        cmocka_unit_test(every_code_has_a_name_and_an_exit_class),
        cmocka_unit_test(floods_are_bounded),
        cmocka_unit_test(threads_may_share_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
