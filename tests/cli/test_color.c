#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/cli/run.h"

#define SHIPPED(name) KILN_TEST_DATA "/compare/" name

static double error_in(const json_t *json, const char *name) {
    return json_number_value(json_object_get(json_object_get(json, "metrics"), name));
}

static json_t *compared(const place *p, int code, const char *const *arguments) {
    result r = run_list(p, arguments);
    if (r.code != code) fail_msg("exit code %d: %s", r.code, r.err);
    json_t *json = json_loads(r.out, 0, NULL);
    assert_non_null(json);
    assert_int_equal(json_integer_value(json_object_get(json, "exit_code")), code);
    result_free(&r);
    return json;
}

static void all_metrics_are_told(void **state) {
    const place *p = *state;
    json_t *json = compared(p, 0, (const char *const[]){"color", "--compare", SHIPPED("noise_b.png"),
                                                        SHIPPED("noise_a.png"), "--json", NULL});
    assert_int_equal(json_object_size(json_object_get(json, "metrics")), 4);
    assert_true(fabs(error_in(json, "flip") - 0.1420) < 1e-3);  /* tests/data/compare/flip.json */
    assert_true(fabs(error_in(json, "mse") - 0.08 * 0.08) < 1e-3); /* tools/make_flip_pairs.py: a deviation of 0.08 */
    assert_int_equal(json_integer_value(json_object_get(json, "width")), 41);
    json_decref(json);
    result r = run(p, "color", "--compare", SHIPPED("noise_b.png"), SHIPPED("noise_a.png"));
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "flip      0.142"));
    result_free(&r);
    assert_int_equal(files_in(p), 0);
}

static void flip_of_linear_pictures_is_over_exposures(void **state) {
    json_t *json =
        compared(*state, 0, (const char *const[]){"color", "--compare", SHIPPED("lamp_linear_b.exr"),
                                                  SHIPPED("lamp_linear_a.exr"), "--metric=flip", "--json", NULL});
    assert_int_equal(json_object_size(json_object_get(json, "metrics")), 1);
    assert_true(fabs(error_in(json, "hdr-flip") - 0.0153) < 1e-3);
    json_decref(json);
}

static void a_threshold_decides_the_exit_code(void **state) {
    const place *p = *state;
    const char *a = SHIPPED("noise_a.png"), *b = SHIPPED("noise_b.png");
    assert_runs(p, "color", "--compare", b, a, "--metric", "flip", "--threshold", "0.143", "--quiet");
    assert_runs(p, "color", "--compare", a, a, "--threshold", "0");
    result r = run(p, "color", "--compare", b, a, "--metric", "flip", "--threshold", "0.141");
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "above the threshold of 0.141"));
    assert_non_null(strstr(r.out, "flip      0.142"));
    result_free(&r);
    json_t *json =
        compared(p, 1, (const char *const[]){"color", "--compare", b, a, "--threshold", "0.001", "--json", NULL});
    assert_true(json_is_true(json_object_get(json, "above")));
    assert_true(error_in(json, "relmse") > 0.001);
    json_decref(json);
}

static void a_map_is_numbers_or_false_colours(void **state) {
    const place *p = *state;
    uint32_t width, height, channels;
    json_t *json =
        compared(p, 0, (const char *const[]){"color", "--compare", SHIPPED("edge_b.png"), SHIPPED("edge_a.png"), "--metric",
                                             "mse", "-o", "map.png", "-o", "map.exr", "--json", NULL});
    float *values = read_picture(p, "map.exr", &width, &height, &channels);
    assert_int_equal(width * height, 41 * 29);
    double sum = 0;
    for (size_t i = 0; i < 41 * 29; i++) sum += (double)values[i * channels];
    assert_true(fabs(sum / (41 * 29) - error_in(json, "mse")) < 1e-6);
    free(values);
    float *colors = read_picture(p, "map.png", &width, &height, &channels);
    assert_int_equal(channels, 3);
    assert_true(colors[0] + colors[1] + colors[2] < 0.01f);       /* far from the edge: black */
    assert_true(colors[3 * (14 * 41 + 20)] > 0.9f);               /* on it: the bright end */
    free(colors);
    json_decref(json);
}

static void a_picture_is_shown_by_the_view(void **state) {
    const place *p = *state;
    uint32_t width, height, channels;
    assert_runs(p, "color", SHIPPED("lamp_linear_a.exr"), "-o", "a.png", "--view", "Raw", "--exposure", "-1");
    float *v = read_picture(p, "a.png", &width, &height, &channels);
    assert_int_equal(width * height, 41 * 29);
    assert_true(v[3 * (20 * 41 + 30)] == 1); /* the lamp of 100 */
    free(v);
    result r = run(p, "color", "--list");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "displays"));
    result_free(&r);
}

static void what_cannot_be_compared_is_refused(void **state) {
    const place *p = *state;
    const char *a = SHIPPED("noise_a.png"), *linear = SHIPPED("noise_linear_a.exr");
    write_file(p, "text.png", "no picture", 10);
    assert_refused(p, 2, "--compare needs two pictures", "color", "--compare", a);
    assert_refused(p, 2, "kiln color takes one PICTURE", "color", "--compare", a, a, a);
    assert_refused(p, 3, "is display-referred, and", "color", "--compare", a, linear);
    assert_refused(p, 3, "nothing.png", "color", "--compare", "nothing.png", a);
    assert_refused(p, 3, "text.png", "color", "--compare", a, "text.png");
    assert_refused(p, 2, "'psnr' is not a metric", "color", "--compare", a, a, "--metric", "psnr");
    assert_refused(p, 2, "the suffix names no format", "color", "--compare", a, a, "-o", "map.gif");
    assert_refused(p, 2, "nothing says what to write", "color", linear);
    assert_refused(p, 3, "there is nothing to convert", "color", a, "-o", "b.png");
    assert_refused(p, 2, "a view makes pictures for displays", "color", linear, "-o", "b.exr");
    assert_refused(p, 2, "kiln color needs a picture", "color");
    assert_refused(p, 2, "unknown option '--spp'", "color", "--spp", "4", a);
    assert_refused(p, 2, "unknown option '--compare'", "render", "--compare", a);
    assert_runs(p, "color", linear, "-o", "small.png");
    assert_runs(p, "render", PAIR("roughness_factor_a"), "--size", "8x9", "--spp", "1", "-o", "other.png");
    assert_runs(p, "render", PAIR("roughness_factor_a"), "--size", "8x9", "--spp", "1", "-o", "alpha.png", "--background",
                "transparent");
    assert_refused(p, 3, "has 4 channels, and other.png 3", "color", "--compare", "alpha.png", "other.png");
    assert_refused(p, 3, "has 41 x 29 pixels, and other.png 8 x 9", "color", "--compare", "small.png", "other.png");
    assert_refused(p, 2, "is one of the pictures", "color", "--compare", "small.png", a, "-o", "./small.png");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        CLI_TEST(all_metrics_are_told), CLI_TEST(flip_of_linear_pictures_is_over_exposures),
        CLI_TEST(a_threshold_decides_the_exit_code), CLI_TEST(a_map_is_numbers_or_false_colours),
        CLI_TEST(a_picture_is_shown_by_the_view), CLI_TEST(what_cannot_be_compared_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
