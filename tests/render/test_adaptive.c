/* Where samples go: to where they lower the error most, as many as were asked for, in the same way on any number of
 * threads, and without a bias that would show. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/adaptive.h"
#include "tests/render/scenes.h"

enum { SIDE = 48, PIXELS = SIDE * SIDE, HAVE = 16, THIRD = SIDE / 3 };

/* A film whose pixels are 1 on average and whose replicates differ by `spread` of the column to either side. */
static kiln_film *make_film(const double spread[3]) {
    kiln_film *f;
    kiln_report *report = kiln_report_create();
    assert_true(kiln_film_create(&(kiln_film_desc){.width = SIDE, .height = SIDE}, &f, report));
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++)
            for (int n = 0; n < HAVE; n++) {
                float value = (float)(1 + (n % 2 ? spread[x / THIRD] : -spread[x / THIRD]));
                film_add(f, x, y, &(film_sample){.radiance = {value, value, value}, .alpha = 1});
            }
    kiln_report_destroy(report);
    return f;
}

static void plan(const double spread[3], uint32_t mean, uint32_t targets[PIXELS]) {
    kiln_film *f = make_film(spread);
    assert_true(adaptive_plan(f, 1, (uint64_t)mean * PIXELS, targets));
    kiln_film_destroy(f);
}

static void sums_are_kept(void **state) {
    (void)state;
    static uint32_t targets[PIXELS];
    for (uint32_t mean = 17; mean < 300; mean = mean * 3 / 2) {
        plan((double[]){0.01, 0.2, 0.03}, mean, targets);
        double sum = 0;
        for (int i = 0; i < PIXELS; i++) {
            assert_true(targets[i] >= HAVE && targets[i] % (2 * KILN_REPLICATES) == 0);
            sum += targets[i];
        }
        assert_true(fabs(sum - (double)mean * PIXELS) <= 4 * 2 * KILN_REPLICATES);
    }
}

/* Columns of one spread are far from others: n goes with it, for e is its square. */
static void shares_follow_the_root(void **state) {
    (void)state;
    static uint32_t targets[PIXELS];
    plan((double[]){0.1, 0.2, 0.4}, 256, targets);
    double mean[3] = {0, 0, 0};
    enum { MARGIN = 4 };
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (x % THIRD >= MARGIN && x % THIRD < THIRD - MARGIN)
                mean[x / THIRD] += targets[y * SIDE + x] / (double)(SIDE * (THIRD - 2 * MARGIN));
    assert_true(fabs(mean[1] / mean[0] - 2) < 0.02 && fabs(mean[2] / mean[0] - 4) < 0.04);
    plan((double[]){0, 0, 0.4}, 32, targets);
    for (int y = 0; y < SIDE; y++) assert_int_equal(targets[y * SIDE + 3], HAVE); /* nothing errs there */
    plan((double[]){0, 0, 0}, 32, targets);
    for (int i = 0; i < PIXELS; i++) assert_int_equal(targets[i], 32);
}

/* (mean √e)²/mean e, of thirds with spreads 1, 2 and 4: (7/3)²/7; the blurred seams between them change little. */
static void the_gain_is_known(void **state) {
    (void)state;
    kiln_film *f = make_film((double[]){0.1, 0.2, 0.4});
    assert_true(fabs(adaptive_gain(f, 1) - 7.0 / 9) < 0.03);
    kiln_film_destroy(f);
    f = make_film((double[]){0.3, 0.3, 0.3});
    assert_true(fabs(adaptive_gain(f, 1) - 1) < 1e-5);
    kiln_film_destroy(f);
}

/* A floor in part under the sky, a glossy ball, a lamp. */
static void fill(scene_builder *b) {
    kiln_material floor = diffuse_material(0.7f, 0.6f, 0.5f), ball = kiln_material_default();
    kiln_material lamp = diffuse_material(0, 0, 0);
    for (int k = 0; k < 3; k++) lamp.emission.value[k] = 20;
    ball.roughness.value = 0.3f;
    add_quad(b, add_material(b, &floor), (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    add_quad(b, add_material(b, &lamp), (float[]){-.3f, 2, -.3f, .3f, 2, -.3f, .3f, 2, .3f, -.3f, 2, .3f});
    add_sphere(b, add_material(b, &ball), (float[]){0, 0.5f, 0}, 0.5f, 16, 0);
    set_environment(b, 0, 0.1f, 0.1f, 0.1f);
}

enum { SIDE_SEEN = 32, SEEN = SIDE_SEEN * SIDE_SEEN };

typedef struct room { scene_builder b; kiln_renderer *renderer; kiln_camera view; } room;

static room open_room(uint32_t threads) {
    room r = {.b = builder_make(), .view = camera_at((float[]){0, 2, 4}, (float[]){0, 0.5f, 0}, 40)};
    fill(&r.b);
    must(kiln_scene_commit(r.b.scene, r.b.report), r.b.report, "committing");
    must(kiln_renderer_create(r.b.scene, &(kiln_renderer_options){.threads = threads}, &r.renderer, r.b.report), r.b.report,
         "making a renderer");
    return r;
}
static void close_room(room *r) {
    kiln_renderer_destroy(r->renderer);
    builder_free(&r->b);
}
static picture shoot(const room *r, kiln_render_options o) {
    o.camera = &r->view;
    return render_with(r->renderer, &o, &(kiln_film_desc){.width = SIDE_SEEN, .height = SIDE_SEEN}, r->b.report);
}

static void rules_choose(void **state) {
    (void)state;
    room r = open_room(2);
    static const struct { kiln_render_options options; bool adaptive; } rows[] = {
        {{.spp = 64}, false},
        {{.spp = 64, .adaptive = KILN_ADAPTIVE_ON}, true},
        {{.spp = 64, .noise = 1e-4}, true},
        {{.spp = 64, .budget_seconds = 1e3}, true},
        {{.spp = 64, .noise = 1e-4, .adaptive = KILN_ADAPTIVE_OFF}, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        picture p = shoot(&r, rows[i].options);
        assert_int_equal(p.stats.adaptive, rows[i].adaptive);
        assert_int_equal(p.stats.spp, 64);
        assert_true(rows[i].adaptive ? p.stats.spp_least < 64 && p.stats.spp_most > 64
                                     : p.stats.spp_least == 64 && p.stats.spp_most == 64);
        picture_free(&p);
    }
    close_room(&r);
}

/* Also when the film is gone on with where a rule would have judged it. */
static void threads_make_no_difference(void **state) {
    (void)state;
    room one = open_room(1), three = open_room(3);
    kiln_render_options o = {.spp = 128, .adaptive = KILN_ADAPTIVE_ON};
    picture a = shoot(&one, o);
    o.tile_shuffle = 0x123456789abcdef;
    o.batch_size = 112;
    picture b = shoot(&three, o);
    assert_memory_equal(a.rgb, b.rgb, 3 * SEEN * sizeof(float));
    picture_free(&b);
    o = (kiln_render_options){.spp = 32, .adaptive = KILN_ADAPTIVE_ON};
    picture c = shoot(&one, o);
    o.spp = 128, o.camera = &one.view;
    assert_true(kiln_render(one.renderer, &o, c.film, NULL, one.b.report));
    kiln_film_beauty(c.film, c.rgb);
    assert_memory_equal(a.rgb, c.rgb, 3 * SEEN * sizeof(float));
    picture_free(&a);
    picture_free(&c);
    close_room(&one);
    close_room(&three);
}

static double relative_square(const double *a, const double *b) {
    double sum = 0;
    for (int i = 0; i < 3 * SEEN; i++) sum += (a[i] - b[i]) * (a[i] - b[i]) / (b[i] * b[i] + 0.01);
    return sum / (3 * SEEN);
}

/* The mean over seeds of pictures, and of their relMSE against a reference. */
static double mean_of_seeds(const room *r, kiln_adaptive adaptive, int seeds, const double *reference, double *mean) {
    double error = 0, *one = malloc(3 * SEEN * sizeof *one);
    memset(mean, 0, 3 * SEEN * sizeof *mean);
    for (int s = 0; s < seeds; s++) {
        picture p = shoot(r, (kiln_render_options){.spp = 32, .seed = (uint64_t)s, .adaptive = adaptive, .max_depth = 3});
        for (int i = 0; i < 3 * SEEN; i++) one[i] = (double)p.rgb[i], mean[i] += one[i] / seeds;
        error += relative_square(one, reference) / seeds;
        picture_free(&p);
    }
    free(one);
    return error;
}

/* bias² = |mean of seeds − reference|² less what the noise of either adds; the root of it is below a tenth of the root
 * of relMSE, and the error below that of as many samples spread evenly. */
static void bias_is_small(void **state) {
    (void)state;
    enum { SEEDS = 150, REFERENCE_SPP = 16384 };
    double *reference = malloc(3 * SEEN * sizeof *reference), *mean = malloc(3 * SEEN * sizeof *mean);
    room r = open_room(2);
    picture p = shoot(&r, (kiln_render_options){.spp = REFERENCE_SPP, .seed = 1u << 20, .max_depth = 3});
    for (int i = 0; i < 3 * SEEN; i++) reference[i] = (double)p.rgb[i];
    double even = mean_of_seeds(&r, KILN_ADAPTIVE_OFF, SEEDS, reference, mean);
    double even_off = relative_square(mean, reference) - even / SEEDS; /* the reference's noise */
    double error = mean_of_seeds(&r, KILN_ADAPTIVE_ON, SEEDS, reference, mean);
    double off = relative_square(mean, reference) - error / SEEDS - even_off;
    print_message("relMSE %.5f even, %.5f adaptive; bias %.3f of the error\n", even, error, sqrt(fmax(off, 0) / error));
    assert_true(off < 0.01 * error);
    assert_true(error < 0.9 * even);
    picture_free(&p);
    close_room(&r);
    free(reference);
    free(mean);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_are_kept),
        cmocka_unit_test(shares_follow_the_root),
        cmocka_unit_test(the_gain_is_known),
        cmocka_unit_test(rules_choose),
        cmocka_unit_test(threads_make_no_difference),
        cmocka_unit_test(bias_is_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
