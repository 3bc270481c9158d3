/* Metrics against closed forms, and FLIP against its authors' evaluator (tools/make_flip_pairs.py). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/image.h"
#include "image/ramp.h"
#include "kiln/compare.h"

enum { WIDTH = 3, HEIGHT = 2 };

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (b)) < (tolerance))

static double error_of(kiln_metric metric, const float *image, const float *reference, float *map) {
    kiln_report *report = kiln_report_create();
    kiln_comparison c = {.metric = metric, .width = WIDTH, .height = HEIGHT, .image = image, .reference = reference};
    double error;
    assert_true(kiln_compare(&c, &error, map, report));
    kiln_report_destroy(report);
    return error;
}

static void errors_have_closed_forms(void **state) {
    (void)state;
    float a[WIDTH * HEIGHT * 3] = {0}, b[WIDTH * HEIGHT * 3] = {0}, map[WIDTH * HEIGHT];
    a[0] = 0.5f, b[0] = 0.2f;   /* pixel 0: a difference of 0.3 at 0.2 */
    a[16] = -1.0f, b[16] = 1.0f; /* pixel 5: of −2 at 1 */
    const double count = WIDTH * HEIGHT * 3;
    assert_near(error_of(KILN_METRIC_MSE, a, b, map), (0.09 + 4) / count, 1e-7);
    assert_near(map[0], 0.03, 1e-7);
    assert_near(map[5], 4.0 / 3, 1e-6);
    assert_true(map[1] == 0);
    assert_near(error_of(KILN_METRIC_MAE, a, b, map), 2.3 / count, 1e-7);
    assert_near(error_of(KILN_METRIC_RELMSE, a, b, map), (0.09 / 0.05 + 4 / 1.01) / count, 1e-6);
    assert_near(map[0], 0.09 / 0.05 / 3, 1e-6);
}

static void equal_pictures_differ_by_nothing(void **state) {
    (void)state;
    float a[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) a[i] = (float)i / 7;
    for (int m = 0; m < KILN_METRIC_COUNT; m++) assert_true(error_of((kiln_metric)m, a, a, NULL) == 0);
}

static void flip_is_bounded(void **state) {
    (void)state;
    float black[WIDTH * HEIGHT * 3] = {0}, bright[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) bright[i] = i % 2 ? 1e30f : -1e30f;
    for (int m = KILN_METRIC_FLIP; m <= KILN_METRIC_HDR_FLIP; m++) {
        double error = error_of((kiln_metric)m, bright, black, NULL);
        assert_true(error > 0.3 && error <= 1);
    }
}

static void what_is_no_number_is_refused(void **state) {
    (void)state;
    float a[WIDTH * HEIGHT * 3] = {0}, b[WIDTH * HEIGHT * 3] = {0};
    kiln_comparison c = {.width = WIDTH, .height = HEIGHT, .image = a, .reference = b};
    for (int which = 0; which < 2; which++) {
        kiln_report *report = kiln_report_create();
        double error;
        float *v = which ? b : a;
        v[13] = which ? INFINITY : NAN;
        assert_false(kiln_compare(&c, &error, NULL, report));
        assert_non_null(strstr(kiln_report_message(report, 0).what, "the first at 1,1"));
        assert_non_null(strstr(kiln_report_message(report, 0).what, which ? "reference" : "picture"));
        v[13] = 0;
        kiln_report_destroy(report);
    }
}

/* CIE L* of an sRGB colour. */
static double lightness(const float rgb[3]) {
    const double weights[3] = {0.2126, 0.7152, 0.0722};
    double y = 0;
    for (int k = 0; k < 3; k++) y += weights[k] * pow(((double)rgb[k] + 0.055) / 1.055, 2.4);
    return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

static void false_colours_rise_in_lightness(void **state) {
    (void)state;
    float before[3], rgb[3], values[3000] = {0};
    image_ramp(0, before);
    for (int i = 1; i <= 100; i++) {
        image_ramp((float)i / 100, rgb);
        assert_true(lightness(rgb) > lightness(before));
        assert_true(fabs(lightness(rgb) - i) < 6);
        for (int k = 0; k < 3; k++) before[k] = rgb[k];
    }
    image_ramp(NAN, rgb);
    assert_true(rgb[0] == 0);
    assert_true(image_ramp_end(values, 3000) == 0);
    values[7] = 100;
    assert_true(image_ramp_end(values, 3000) == 100);
    for (int i = 0; i < 2990; i++) values[i] = i < 3 ? 1000 : 2;
    assert_true(image_ramp_end(values, 3000) == 2);
}

/* RGB floats of a shipped picture, integers as 0 … 1; free(). */
static float *load(const char *name, uint32_t *width, uint32_t *height) {
    kiln_report *report = kiln_report_create();
    char path[512];
    kiln_bytes bytes;
    kiln_image image;
    snprintf(path, sizeof path, "%s/compare/%s", KILN_TEST_DATA, name);
    kiln_where where = where_root(path);
    assert_true(file_read(path, 1 << 20, &bytes, NULL, report));
    assert_true(image_decode(bytes.data, bytes.size, 0, &image, &where, report));
    assert_int_equal(image.channels, 3);
    size_t count = (size_t)image.width * image.height * 3;
    float *values = malloc(count * sizeof *values);
    for (size_t i = 0; i < count; i++)
        values[i] =
            image.format == KILN_PIXELS_F32 ? ((float *)image.pixels)[i] : ((uint8_t *)image.pixels)[i] / 255.0f;
    *width = image.width, *height = image.height;
    image_free(&image);
    file_free(&bytes);
    kiln_report_destroy(report);
    return values;
}

static void compare_pair(const json_t *pair) {
    const char *name = json_string_value(json_object_get(pair, "reference"));
    kiln_report *report = kiln_report_create();
    uint32_t width, height;
    float *a = load(name, &width, &height);
    float *b = load(json_string_value(json_object_get(pair, "picture")), &width, &height);
    float *map = malloc((size_t)width * height * sizeof *map);
    kiln_comparison c = {.metric = strstr(name, ".exr") ? KILN_METRIC_HDR_FLIP : KILN_METRIC_FLIP, .width = width,
                         .height = height, .image = b, .reference = a};
    double error;
    assert_true(kiln_compare(&c, &error, map, report));
    double golden = json_number_value(json_object_get(pair, "mean"));
    if (fabs(error - golden) > 1e-4) fail_msg("%s: the mean is %.6f, and %.6f by the evaluator", name, error, golden);
    const json_t *pixel;
    size_t i;
    json_array_foreach(json_object_get(pair, "pixels"), i, pixel) {
        size_t x = (size_t)json_integer_value(json_array_get(pixel, 0));
        size_t y = (size_t)json_integer_value(json_array_get(pixel, 1));
        double there = (double)map[y * width + x], value = json_number_value(json_array_get(pixel, 2));
        if (fabs(there - value) > 1e-3) fail_msg("%s: pixel %zu,%zu is %.6f, not %.6f", name, x, y, there, value);
    }
    free(a), free(b), free(map);
    kiln_report_destroy(report);
}

static void flip_is_that_of_its_authors(void **state) {
    (void)state;
    json_t *root = json_load_file(KILN_TEST_DATA "/compare/flip.json", 0, NULL);
    const json_t *pair;
    size_t i;
    assert_int_equal(json_array_size(json_object_get(root, "pairs")), 7);
    json_array_foreach(json_object_get(root, "pairs"), i, pair) compare_pair(pair);
    json_decref(root);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_have_closed_forms), cmocka_unit_test(equal_pictures_differ_by_nothing),
        cmocka_unit_test(flip_is_bounded), cmocka_unit_test(what_is_no_number_is_refused),
        cmocka_unit_test(false_colours_rise_in_lightness), cmocka_unit_test(flip_is_that_of_its_authors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
