#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <sys/stat.h>

#include "job/outputs.h"
#include "tests/job/support.h"

static const template_values values = {"car", "auto", "default", 0};

static bool plan(fixture *f, output_plan *p) { return outputs_plan(&f->options, &values, p, f->report); }

static void the_default_is_named_by_the_asset(void **state) {
    fixture *f = *state;
    output_plan p;
    assert_done(f, plan(f, &p));
    assert_int_equal(p.count, 1);
    assert_string_equal(p.items[0].path, "car.png");
    outputs_free(&p);
}

static void suffixes_choose_the_format(void **state) {
    (void)state;
    const struct { const char *path; output_kind kind; } rows[] = {
        {"a.PNG", OUTPUT_DISPLAY}, {"-", OUTPUT_DISPLAY}, {"a.b/c.jpeg", OUTPUT_DISPLAY}, {"x.exr", OUTPUT_EXR},
        {"x.hdr", OUTPUT_HDR},     {"x.bmp", OUTPUT_UNKNOWN}, {"png", OUTPUT_UNKNOWN},    {"", OUTPUT_UNKNOWN}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_int_equal(output_kind_of(rows[i].path), rows[i].kind);
}

static void assert_refused(fixture *f, const char *text) {
    output_plan p;
    assert_false(plan(f, &p));
    assert_true(says(f->report, text));
    assert_int_equal(kiln_report_exit_code(f->report), 2);
    outputs_free(&p);
}

static void unknown_suffixes_are_refused(void **state) {
    give(*state, "output", "a.gif");
    assert_refused(*state, "no format");
}

/* By folder and name, however they are spelled; statistics count. */
static void outputs_are_distinct(void **state) {
    fixture *f = *state;
    static const struct { const char *outputs[2], *stats, *says; } rows[] = {
        {{"car.png", "{name}.png"}, NULL, "another output is this file"},
        {{"car.png", "./car.png"}, "s.json", "another output is this file"},
        {{"-", "-"}, NULL, "another output is this file"},
        {{"a.png", "b.png"}, "./b.png", "the picture's output is this file"},
        {{"a.png", "b.png"}, "c.png", NULL}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        output_plan p;
        job_options_free(&f->options);
        assert_done(f, job_options_init(&f->options, f->report));
        for (int k = 0; k < 2; k++) give(f, "output", rows[i].outputs[k]);
        assert_done(f, plan(f, &p));
        kiln_report_clear(f->report);
        assert_int_equal(outputs_check_distinct(&p, rows[i].stats, f->report), !rows[i].says);
        assert_true(!rows[i].says || says(f->report, rows[i].says));
        assert_int_equal(kiln_report_exit_code(f->report), rows[i].says ? 2 : 0);
        outputs_free(&p);
    }
}

static void what_is_read_is_not_written(void **state) {
    fixture *f = *state;
    char input[256], link[256], other[256];
    output_plan p;
    assert_true(file_replace(path_in(f, "a.png", input), "a", 1, f->report));
    assert_int_equal(symlink("a.png", path_in(f, "l.png", link)), 0);
    path_in(f, "b.png", other);
    file_identity read = file_identify(input);
    give(f, "output", other);
    assert_done(f, plan(f, &p));
    assert_done(f, outputs_check_input(&p, NULL, read, "the asset consists of", f->report));
    assert_done(f, outputs_check_input(&p, "-", read, "the asset consists of", f->report));
    assert_false(outputs_check_input(&p, link, read, "the asset consists of", f->report));
    assert_true(says(f->report, "--stats"));
    outputs_free(&p);
    kiln_report_clear(f->report);
    give(f, "output", link);
    assert_done(f, plan(f, &p));
    assert_false(outputs_check_input(&p, NULL, read, "the asset consists of", f->report));
    assert_true(says(f->report, "overwrite a file that the asset consists of"));
    assert_true(says(f->report, "with -o"));
    assert_int_equal(kiln_report_exit_code(f->report), 2);
    outputs_free(&p);
}

static void opaque_formats_cannot_be_transparent(void **state) {
    give(*state, "background", "transparent");
    give(*state, "output", "car.jpg");
    assert_refused(*state, "JPEG cannot be transparent");
}

static void layers_need_a_file_that_holds_them(void **state) {
    give(*state, "aov", "albedo");
    give(*state, "output", "car.png");
    assert_refused(*state, "no output can hold");
}

static void trying_leaves_nothing_behind(void **state) {
    fixture *f = *state;
    char path[256], stats[256];
    output_plan p;
    give(f, "output", path_in(f, "a.png", path));
    give(f, "output", path_in(f, "b.exr", path));
    assert_done(f, plan(f, &p));
    assert_done(f, outputs_try(&p, path_in(f, "s.json", stats), f->report));
    assert_int_equal(files_in(f->folder), 0);
    outputs_free(&p);
}

static void folders_that_are_not_there_are_found_out(void **state) {
    fixture *f = *state;
    char path[256];
    output_plan p;
    give(f, "output", path_in(f, "missing/a.png", path));
    assert_done(f, plan(f, &p));
    assert_false(outputs_try(&p, NULL, f->report));
    assert_int_equal(kiln_report_exit_code(f->report), 1);
    outputs_free(&p);
    kiln_report_clear(f->report);
    assert_false(outputs_try(&p, path_in(f, "missing/s.json", path), f->report));
}

static void a_folder_in_the_way_is_found_out(void **state) {
    fixture *f = *state;
    char path[256];
    output_plan p;
    path_in(f, "a.png", path);
    assert_int_equal(mkdir(path, 0777), 0);
    give(f, "output", path);
    assert_done(f, plan(f, &p));
    assert_false(outputs_try(&p, NULL, f->report));
    assert_true(says(f->report, "Is a directory"));
    outputs_free(&p);
    rmdir(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(the_default_is_named_by_the_asset),
                                       cmocka_unit_test(suffixes_choose_the_format),
                                       JOB_TEST(unknown_suffixes_are_refused),
                                       JOB_TEST(outputs_are_distinct),
                                       JOB_TEST(what_is_read_is_not_written),
                                       JOB_TEST(opaque_formats_cannot_be_transparent),
                                       JOB_TEST(layers_need_a_file_that_holds_them),
                                       JOB_TEST(trying_leaves_nothing_behind),
                                       JOB_TEST(folders_that_are_not_there_are_found_out),
                                       JOB_TEST(a_folder_in_the_way_is_found_out)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
