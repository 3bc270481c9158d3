#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/cli/run.h"

#define SCENE PAIR("roughness_factor_a")

static void a_study_is_made_and_gone_on_with(void **state) {
    const place *p = *state;
    const char *const arguments[] = {"study", SCENE, "-o", "s", "--preset=effects", "--size", "8x8", "--spp", "4",
                                     "--noise", "1%", "--json", NULL};
    result r = run_list(p, arguments);
    if (r.code) fail_msg("exit code %d: %s", r.code, r.err);
    json_t *json = json_loads(r.out, 0, NULL);
    assert_true(json_is_true(json_object_get(json, "complete")));
    assert_true(json_array_size(json_object_get(json, "configs")) > 2);
    assert_non_null(strstr(json_string_value(json_array_get(json_object_get(json, "advice"), 0)), "1 %"));
    assert_true(has_file(p, "s/report.html") && has_file(p, "s/study.json") && has_file(p, "s/reference.exr"));
    assert_true(has_file(p, "s/pictures/base.webp") && has_file(p, "s/pictures/effects=-reflection.error.webp"));
    json_decref(json);
    result_free(&r);
    r = run(p, "study", SCENE, "-o", "s", "--preset=effects", "--size", "8x8", "--spp", "4", "--noise", "2%");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.err, "s: going on after")); /* the target is no part of what was measured */
    assert_non_null(strstr(r.out, "effects=-reflection"));
    assert_non_null(strstr(r.out, "For an error of 2 %"));
    result_free(&r);
    r = run(p, "study", SCENE, "-o", "s", "--preset=effects", "--size", "8x8", "--spp", "4", "--max-depth", "3");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.err, "beginning anew"));
    result_free(&r);
}

static void what_cannot_be_studied_is_refused(void **state) {
    const place *p = *state;
    write_file(p, "file", "x", 1);
    assert_refused(p, 2, "nothing says into which folder", "study", SCENE);
    assert_refused(p, 2, "the preset default needs a scene", "study", "-o", "s");
    assert_refused(p, 2, "'stability' is not a preset", "study", "-o", "s", "--preset", "stability");
    assert_refused(p, 2, "unknown option '--crop'", "study", SCENE, "-o", "s", "--crop", "0,0,4,4");
    assert_refused(p, 2, "unknown option '--preset'", "render", SCENE, "--preset", "roulette");
    assert_refused(p, 3, "nothing.glb", "study", "nothing.glb", "-o", "s");
    assert_refused(p, 1, "is not a folder", "study", SCENE, "-o", "file");
}

/* Where there is a Chromium: the script in the report runs without an error, and draws. */
static void a_browser_shows_the_report(void **state) {
    const place *p = *state;
    char command[512];
    if (system("command -v chromium >/dev/null 2>&1")) skip();
    assert_runs(p, "study", SCENE, "-o", "s", "--preset=estimators", "--size", "8x8", "--spp", "4");
    snprintf(command, sizeof command,
             "chromium --headless --no-sandbox --disable-gpu --user-data-dir=%s/profile --virtual-time-budget=5000 "
             "--dump-dom file://%s/s/report.html >%s/dom.html 2>%s/log; ! grep -q Uncaught %s/log",
             p->streams, p->folder, p->streams, p->streams, p->streams);
    assert_int_equal(system(command), 0);
    snprintf(command, sizeof command, "test $(grep -o '<svg' %s/dom.html | wc -l) = 3 && grep -q 'Left of the divider' "
             "%s/dom.html && grep -q 'estimator naive' %s/dom.html", p->streams, p->streams, p->streams);
    assert_int_equal(system(command), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(a_study_is_made_and_gone_on_with),
                                       CLI_TEST(what_cannot_be_studied_is_refused),
                                       CLI_TEST(a_browser_shows_the_report)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
