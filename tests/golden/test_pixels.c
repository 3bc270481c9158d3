/* For every feature a pair of files that differ in it alone: their pictures differ too. The pictures' means stand in a
 * golden text, to within what other random numbers change; they were looked at once. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/text.h"
#include "kiln/import.h"
#include "kiln/render.h"
#include "tests/golden/golden.h"
#include "tests/golden/pairs.h"

enum { SIDE = 48, SPP = 16 };

static void must(bool ok, const kiln_report *report, const char *path) {
    if (!ok) fail_msg("%s: %s", path, kiln_report_size(report) ? kiln_report_message(report, 0).what : "failed");
}

/* A dim sky, brighter above, so that what no lamp of the file reaches is not black; it hides no feature. */
static void add_sky(kiln_scene *scene, kiln_report *report) {
    float rows[16 * 3];
    for (int i = 0; i < 48; i++) rows[i] = 0.4f - 0.02f * (float)(i / 3);
    kiln_id image;
    kiln_image_desc desc = {.name = "sky", .pixels = rows, .width = 1, .height = 16, .channels = 3, .format = KILN_PIXELS_F32};
    kiln_environment sky = {.transfer = KILN_TRANSFER_LINEAR, .color = {1, 1, 1}};
    must(kiln_scene_add_image(scene, &desc, &image, report), report, "sky");
    sky.image = image;
    must(kiln_scene_set_environment(scene, &sky, report), report, "sky");
}

static float *shoot(const char *path) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    kiln_renderer *renderer;
    kiln_film *film;
    must(kiln_import(path, NULL, &scene, report), report, path);
    add_sky(scene, report);
    must(kiln_subdivide(scene, &(kiln_subdivide_options){.width = SIDE, .height = SIDE}, NULL, NULL, report), report, path);
    must(kiln_scene_commit(scene, report), report, path);
    must(kiln_renderer_create(scene, NULL, &renderer, report), report, path);
    must(kiln_film_create(&(kiln_film_desc){.width = SIDE, .height = SIDE}, &film, report), report, path);
    must(kiln_render(renderer, &(kiln_render_options){.spp = SPP}, film, NULL, report), report, path);
    float *rgb = malloc(sizeof(float[3]) * SIDE * SIDE);
    kiln_film_beauty(film, rgb);
    kiln_film_destroy(film);
    kiln_renderer_destroy(renderer);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    return rgb;
}

static float *shoot_side(const char *name, const char *side) {
    kiln_text path = {0};
    text_format(&path, "%s/gltf/pairs/%s_%s.gltf", KILN_TEST_DATA, name, side);
    float *rgb = shoot(path.data);
    text_free(&path);
    return rgb;
}

static double mean(const float *rgb) {
    double sum = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) sum += (double)rgb[i];
    return sum / (3 * SIDE * SIDE);
}

/* Pixels that differ by more than a hundredth of what they are. Both pictures have the same random numbers. */
static int differing(const float *a, const float *b) {
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        bool differs = false;
        for (int k = 0; k < 3; k++) {
            double x = (double)a[3 * i + k], y = (double)b[3 * i + k];
            differs |= fabs(x - y) > 0.01 * (fabs(x) + fabs(y)) / 2 + 1e-4;
        }
        count += differs;
    }
    return count;
}

static void features_are_seen(void **state) {
    (void)state;
    size_t count;
    char **names = pair_names(&count);
    kiln_text text = {0};
    for (size_t i = 0; i < count; i++) {
        float *a = shoot_side(names[i], "a"), *b = shoot_side(names[i], "b");
        int pixels = differing(a, b);
        if (pixels < 8) fail_msg("%s: only %d pixels differ", names[i], pixels);
        text_format(&text, "%-32s %7.4f %7.4f\n", names[i], mean(a), mean(b));
        free(a);
        free(b);
    }
    pair_names_free(names, count);
    assert_true(golden_matches_within("gltf/pairs.pixels", text.data, 0.01));
    text_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(features_are_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
