#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "tests/cli/run.h"

#define SCENE PAIR("roughness_factor_a")

static const json_t *at(const json_t *o, const char *a, const char *b) {
    return json_object_get(json_object_get(o, a), b);
}

/* Runs with --json, and hands the document out. */
static json_t *measured(const place *p, const char *const *arguments) {
    result r = run_list(p, arguments);
    if (r.code) fail_msg("exit code %d: %s", r.code, r.err);
    json_t *json = json_loads(r.out, 0, NULL);
    assert_non_null(json);
    result_free(&r);
    return json;
}

static void a_scene_is_measured(void **state) {
    const place *p = *state;
    json_t *json = measured(p, (const char *const[]){"bench", SCENE, "--size", "8x8", "--spp", "2", "--embree",
                                                     "--json", NULL});
    const json_t *stage;
    double shares = 0;
    size_t i;
    assert_int_equal(json_integer_value(at(json, "render", "samples")), 128);
    assert_true(json_number_value(at(json, "render", "samples_per_second")) > 0);
    json_array_foreach(at(json, "render", "stages"), i, stage)
        shares += json_number_value(json_object_get(stage, "share"));
    assert_true(shares > 0.999 && shares < 1.001);
    assert_int_equal(json_array_size(at(json, "render", "runs")), 3);
    assert_true(json_array_size(json_object_get(json, "phases")) >= 6);
    assert_true(json_number_value(json_object_get(json, "first_sample_seconds")) > 0);
    assert_int_equal(json_integer_value(at(json, "embree", "samples")), 128);
    assert_int_equal(json_integer_value(at(json, "embree", "differing_rays")), 0);
    assert_true(json_number_value(at(json, "embree", "render_share")) > 0);
    assert_true(json_integer_value(at(json, "memory", "peak")) > 1000000);
    assert_int_equal(json_integer_value(json_object_get(json, "exit_code")), 0);
    assert_null(json_object_get(json, "growth"));
    json_decref(json);
    assert_int_equal(files_in(p), 0);
}

static void growth_is_measured_axis_by_axis(void **state) {
    json_t *json = measured(*state, (const char *const[]){"bench", SCENE, "--size", "8x8", "--spp", "1", "--growth",
                                                          "pixels:20000,depth:2,triangles:10000,instances:10,lights:10,threads:1",
                                                          "--json", NULL});
    static const struct { const char *axis; size_t rows; } axes[] = {
        {"pixels", 2}, {"depth", 2}, {"triangles", 1}, {"instances", 2}, {"lights", 2}, {"threads", 1}};
    for (size_t i = 0; i < sizeof axes / sizeof *axes; i++) {
        const json_t *rows = at(json, "growth", axes[i].axis), *row;
        size_t k;
        assert_int_equal(json_array_size(rows), axes[i].rows);
        json_array_foreach(rows, k, row) {
            assert_true(json_number_value(json_object_get(row, "samples_per_second")) > 0);
            assert_true(json_integer_value(json_object_get(row, "acceleration")) > 0);
        }
    }
    const json_t *pixels = at(json, "growth", "pixels");
    assert_true(json_integer_value(json_object_get(json_array_get(pixels, 1), "film")) >
                3 * json_integer_value(json_object_get(json_array_get(pixels, 0), "film")));
    json_decref(json);
}

static void without_a_scene_one_is_made(void **state) {
    result r = run(*state, "bench", "--size", "8x8", "--spp", "1", "--embree", "--growth", "depth:1");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "a generated scene: 99,858 triangles, 8 x 8 pixels, 1 samples per pixel"));
    assert_non_null(strstr(r.out, "the render runs at "));
    assert_non_null(strstr(r.out, "peak "));
    assert_non_null(strstr(r.out, "\ndepth "));
    result_free(&r);
}

static void what_it_would_not_look_at_is_refused(void **state) {
    const place *p = *state;
    assert_refused(p, 2, "unknown option '--output'", "bench", SCENE, "--output", "a.png");
    assert_refused(p, 2, "unknown option '--noise'", "bench", SCENE, "--noise", "1%");
    assert_refused(p, 2, "unknown option '--embree'", "render", SCENE, "--embree");
    assert_refused(p, 2, "unknown option '--growth'", "inspect", SCENE, "--growth", "all");
    assert_refused(p, 2, "'teeth' is not a list of pixels", "bench", SCENE, "--growth", "teeth");
    assert_refused(p, 2, "'depth:0' is not a list of pixels", "bench", SCENE, "--growth", "depth:0");
    assert_refused(p, 3, "nothing.glb", "bench", "nothing.glb");
}

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(a_scene_is_measured), CLI_TEST(growth_is_measured_axis_by_axis),
                                       CLI_TEST(without_a_scene_one_is_made),
                                       CLI_TEST(what_it_would_not_look_at_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
