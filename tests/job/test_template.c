#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "job/template.h"
#include "tests/job/support.h"

static const template_values plain = {"car", "Front", "red", 7};

static void assert_expands(const char *pattern, const template_values *v, const char *expected) {
    kiln_report *report = kiln_report_create();
    kiln_text out = {0};
    assert_true(template_expand(pattern, v, &out, NULL, report));
    assert_string_equal(out.data ? out.data : "", expected);
    text_free(&out);
    kiln_report_destroy(report);
}

static void places_are_filled_in(void **state) {
    (void)state;
    assert_expands("a/{name}_{camera}.{variant}.png", &plain, "a/car_Front.red.png");
    assert_expands("{frame}-{frame:4}-####-##.exr", &plain, "7-0007-0007-07.exr");
    assert_expands("C#.png", &plain, "C#.png");
    assert_expands("{{name}}", &plain, "{name}");
    assert_expands("plain.png", &plain, "plain.png");
    template_values late = {"car", "Front", "red", 123456};
    assert_expands("####.{frame:2}", &late, "123456.123456");
}

/* Names come out of files: they must not lead elsewhere. */
static void what_is_filled_in_stays_in_its_folder(void **state) {
    (void)state;
    template_values hostile = {"..", "../../etc/passwd", "", 0};
    assert_expands("x/{name}/{camera}{variant}", &hostile, "x/__/.._.._etc_passwd_");
    template_values control = {"a\nb\x7f", ".", "é", 0};
    assert_expands("{name}{camera}{variant}", &control, "a_b__é");
}

static void other_fields_are_refused(void **state) {
    (void)state;
    const char *const patterns[] = {
        "{nam}",
        "{",
        "a}",
        "{frame:}",
        "{frame:0}",
        "{frame:19}",
        "{frames}",
        "{name",
        "{xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx}"};
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        kiln_report *report = kiln_report_create();
        kiln_text out = {0};
        if (template_expand(patterns[i], &plain, &out, NULL, report)) fail_msg("'%s' was filled in", patterns[i]);
        assert_int_equal(kiln_report_exit_code(report), 2);
        text_free(&out);
        kiln_report_destroy(report);
    }
}

static void assets_are_named_by_their_files(void **state) {
    (void)state;
    const struct {
        const char *path, *name;
    } rows[] = {{"a/b/car.final.glb", "car.final"}, {"car", "car"}, {"-", "stdin"}, {".glb", ".glb"}, {"a.d/", "scene"},
                {"Unicode ❤♻.gltf", "Unicode ❤♻"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *name = template_asset_name(rows[i].path);
        assert_string_equal(name, rows[i].name);
        free(name);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(places_are_filled_in),
                                       cmocka_unit_test(what_is_filled_in_stays_in_its_folder),
                                       cmocka_unit_test(other_fields_are_refused),
                                       cmocka_unit_test(assets_are_named_by_their_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
