/* The film: sums that no order changes and that lose nothing, what it says of its samples, and what is kept out of it.
 * Seeds are fixed. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

static kiln_film *film_of(uint32_t width, uint32_t height, uint32_t aovs) {
    kiln_film *f;
    kiln_report *report = kiln_report_create();
    must(kiln_film_create(&(kiln_film_desc){.width = width, .height = height, .aovs = aovs}, &f, report), report,
         "a film");
    kiln_report_destroy(report);
    return f;
}

/* Floats are whole multiples of 2⁻⁶⁴, or are cut off below that; a sum read back is the nearest double but one. */
static void fixed_point_is_exact(void **state) {
    (void)state;
    static const float exact[] = {0, -0.0f, 1, -1, 0.1f, 0x1p-40f, 0x1.fffffep37f, -0x1.fffffep37f, 0x1.8p-64f};
    for (int i = 0; i < 9; i++)
        assert_true(fixed_to_double(fixed_from_float(exact[i])) == trunc((double)exact[i] * 0x1p64) * 0x1p-64);
    assert_true(fixed_from_float(0x1p-64f) == 1 && fixed_from_float(-0x1p-64f) == -1);
    assert_true(fixed_from_float(0x1.8p-63f) == 3 && fixed_from_float(FLT_MIN) == 0);
    assert_true(fixed_from_float(0x1.fp-65f) == 0 && fixed_from_float(0x1p-149f) == 0);
    assert_true(fixed_fits(0x1.fffffep37f) && fixed_fits(-0x1.fffffep37f) && fixed_fits(0));
    assert_true(!fixed_fits(0x1p38f) && !fixed_fits(INFINITY) && !fixed_fits(-INFINITY) && !fixed_fits(NAN));
    fixed most = 0; /* as many of the largest as a pixel may get */
    most += fixed_from_float(0x1.fffffep37f) * (fixed)FIXED_SAMPLES_MAX;
    assert_true(fixed_to_double(most) == 0x1.fffffep37 * (double)FIXED_SAMPLES_MAX);
}

/* Values over 90 powers of two, which as floats or doubles would lose the small ones: any order gives the same sum, and
 * taking the large ones out again leaves the small ones whole. */
static void sums_do_not_depend_on_their_order(void **state) {
    (void)state;
    enum { COUNT = 100000 };
    float *values = calloc(COUNT, sizeof *values);
    stream s = {41, 0};
    fixed forwards = 0, backwards = 0, strided = 0, tiny = 0;
    for (int i = 0; i < COUNT; i++) {
        values[i] = ldexpf(stream_between(&s, -1, 1), (int)stream_between(&s, -60, 38));
        forwards += fixed_from_float(values[i]);
    }
    for (int i = COUNT; i-- > 0;) backwards += fixed_from_float(values[i]);
    for (int i = 0; i < COUNT; i++) strided += fixed_from_float(values[(int)((int64_t)i * 7919 % COUNT)]);
    assert_true(forwards == backwards && forwards == strided);
    for (int i = 0; i < COUNT; i++) forwards -= fabsf(values[i]) > 1 ? fixed_from_float(values[i]) : 0;
    for (int i = 0; i < COUNT; i++) tiny += fabsf(values[i]) > 1 ? 0 : fixed_from_float(values[i]);
    assert_true(forwards == tiny);
    free(values);
}

/* Sample n belongs to replicate n mod 2; the mean is that of all, its variance Σ (m_r − m)²/(R (R − 1)). */
static void replicates_tell_the_variance(void **state) {
    (void)state;
    kiln_film *f = film_of(2, 1, 0);
    const float values[5] = {1, 4, 2, 8, 3};
    double mean[3], variance[3];
    assert_false(kiln_film_estimate_error(f, 1).known);
    for (int n = 0; n < 5; n++) {
        film_sample x = {.radiance = {values[n], 2 * values[n], 0}};
        film_add(f, 0, 0, &x);
        film_read_pixel(f, 0, mean, variance);
        if (n == 0) assert_true(variance[0] < 0 && mean[0] == 1); /* one replicate says nothing */
        if (n == 1) assert_true(mean[0] == 2.5 && variance[0] == (1.5 * 1.5 + 1.5 * 1.5) / 2);
    }
    assert_true(mean[0] == 3.6 && fabs(mean[1] - 7.2) < 1e-15 && mean[2] == 0); /* replicates: 1 2 3 and 4 8 */
    assert_true(fabs(variance[0] - (1.6 * 1.6 + 2.4 * 2.4) / 2) < 1e-14 && variance[2] == 0);
    assert_int_equal(kiln_film_samples(f), 5);
    assert_int_equal(kiln_film_spp(f), 0); /* the other pixel has none */
    assert_false(kiln_film_estimate_error(f, 1).known);
    kiln_film_destroy(f);
}

enum { SIDE = 40, PIXELS = SIDE * SIDE };

static void add_gray(kiln_film *f, uint32_t pixel, float value, float alpha) {
    film_add(f, pixel % f->width, pixel / f->width, &(film_sample){.radiance = {value, value, value}, .alpha = alpha});
}

/* One pixel's share as docs/estimator.md has it: the reference is the mean of the 24 pixels around, where it lies
 * within 1.2 standard errors. */
static double error_of_pixel(const kiln_film *f, int pixel, double scale) {
    double mean[3], variance[3], around[3] = {0}, own[3], count = 0, sum = 0;
    for (int y = pixel / SIDE - 2; y <= pixel / SIDE + 2; y++)
        for (int x = pixel % SIDE - 2; x <= pixel % SIDE + 2; x++) {
            if (x < 0 || y < 0 || x >= SIDE || y >= SIDE || y * SIDE + x == pixel) continue;
            film_read_pixel(f, (size_t)(y * SIDE + x), mean, variance);
            for (int k = 0; k < 3; k++) around[k] += mean[k];
            count++;
        }
    film_read_pixel(f, (size_t)pixel, own, variance);
    for (int k = 0; k < 3; k++) {
        double ref = around[k] / count;
        if (fabs(ref - own[k]) > 1.2 * sqrt(variance[k])) ref = own[k];
        sum += variance[k] * scale * scale / (ref * ref * scale * scale + 0.01);
    }
    return sum / 3;
}

static int descending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* relMSE is the mean of the pixels' shares, of the picture times its scale; it is trimmed by the worst 1 %, has an
 * interval, and one bright sample costs what it costs against its surroundings, and is a heavy tail. */
static void errors_follow_their_formula(void **state) {
    (void)state;
    for (int tail = 0; tail < 2; tail++) {
        kiln_film *f = film_of(SIDE, SIDE, 0);
        stream s = {42, 0};
        double expected[2] = {0}, shares[PIXELS], top = 0;
        for (uint32_t i = 0; i < PIXELS; i++)
            for (int n = 0; n < 6; n++) {
                film_sample x = {.radiance = {stream_next(&s), stream_next(&s), stream_next(&s)}};
                if (tail && i == 777 && n == 3) x.radiance[0] = 1e4f;
                film_add(f, i % SIDE, i / SIDE, &x);
            }
        for (int i = 0; i < PIXELS; i++) {
            shares[i] = error_of_pixel(f, i, 1);
            expected[0] += shares[i] / PIXELS, expected[1] += error_of_pixel(f, i, 8) / PIXELS;
        }
        if (tail) assert_true(shares[777] > 1e6);
        qsort(shares, PIXELS, sizeof *shares, descending);
        for (int i = 0; i < PIXELS / 100; i++) top += shares[i] / PIXELS;
        kiln_film_error e = kiln_film_estimate_error(f, 1), scaled = kiln_film_estimate_error(f, 8);
        assert_true(e.known && fabs(e.relmse / expected[0] - 1) < 1e-6 && fabs(scaled.relmse / expected[1] - 1) < 1e-6);
        assert_true(fabs(e.relmse_trimmed - (expected[0] - top)) < 0.01 * top);
        assert_true(e.relmse_low > 0 && e.relmse_low < e.relmse && e.relmse < e.relmse_high);
        assert_true(tail ? e.relmse_high > 10 * e.relmse : e.relmse_high < 1.4 * e.relmse);
        assert_int_equal(e.heavy_tail, tail);
        kiln_film_destroy(f);
    }
}

/* Samples of a known mean and variance: what is estimated is variance/n/(mean² + 0.01), but for two per cent of chance
 * in 1,600 pixels of three channels; and the film's threads do not change a bit of it. */
static void known_variance_is_found(void **state) {
    (void)state;
    enum { SPP = 8 };
    kiln_film *f = film_of(SIDE, SIDE, 0);
    stream s = {44, 0};
    double expected = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        float mean = 0.3f + 0.4f * (float)(i % SIDE) / SIDE, deviation = 0.2f * mean;
        for (int n = 0; n < SPP; n++) {
            film_sample x = {.alpha = 1};
            for (int k = 0; k < 3; k++) x.radiance[k] = mean + deviation * sqrtf(12) * (stream_next(&s) - 0.5f);
            film_add(f, i % SIDE, i / SIDE, &x);
        }
        expected += (double)(deviation * deviation) / SPP / ((double)(mean * mean) + 0.01) / PIXELS;
    }
    kiln_film_error e = kiln_film_estimate_error(f, 1);
    if (fabs(e.relmse / expected - 1) > 0.07) fail_msg("%g, not %g", e.relmse, expected);
    assert_true(e.relmse_low <= expected && expected <= e.relmse_high && !e.heavy_tail);
    f->desc.threads = 1;
    kiln_film_error alone = kiln_film_estimate_error(f, 1);
    assert_true(alone.relmse == e.relmse && alone.relmse_high == e.relmse_high);
    assert_true(alone.relmse_trimmed == e.relmse_trimmed);
    kiln_film_destroy(f);
}

/* A noisy object of 10 × 10 pixels in front of a background without noise, dark or bright: the error is that of the
 * object, whatever stands behind it. Where there is no surface at all, every pixel counts. */
static void the_background_does_not_count(void **state) {
    (void)state;
    double relmse[3];
    for (int kind = 0; kind < 3; kind++) {
        kiln_film *f = film_of(SIDE, SIDE, 0);
        stream s = {45, 0};
        for (uint32_t i = 0; i < PIXELS; i++) {
            bool object = i % SIDE < 10 && i / SIDE < 10;
            for (int n = 0; n < 4; n++)
                add_gray(f, i, object ? 0.5f + 0.2f * stream_next(&s) : kind == 1 ? 100.0f : 0.0f, object && kind < 2);
        }
        relmse[kind] = kiln_film_estimate_error(f, 1).relmse;
        kiln_film_destroy(f);
    }
    assert_true(relmse[0] > 1e-3 && relmse[0] == relmse[1]);
    assert_true(relmse[2] < 0.1 * relmse[0] && relmse[2] > 0);
}

/* Albedo and normal are averages over all samples, depth over those that hit, alpha their share; the error is the root
 * of the variance of 5 × 5 pixels. */
static void aovs_are_averages(void **state) {
    (void)state;
    enum { W = 7, H = 6, SPP = 4 };
    kiln_film *f = film_of(W, H, (1u << KILN_AOV_COUNT) - 1);
    stream s = {43, 0};
    double depth[W * H] = {0}, albedo[W * H] = {0}, hits[W * H] = {0};
    for (uint32_t i = 0; i < W * H; i++)
        for (int n = 0; n < SPP; n++) {
            bool hit = i != 3 && stream_next(&s) < 0.7f; /* pixel 3 sees the background alone */
            film_sample x = {.radiance = {stream_next(&s), stream_next(&s), 0}, .alpha = hit, .depth = stream_next(&s),
                             .albedo = {stream_next(&s), 1, 0}, .normal = {0, -1, 0}};
            film_add(f, i % W, i / W, &x);
            hits[i] += hit;
            if (hit) depth[i] += (double)x.depth, albedo[i] += (double)x.albedo[0];
        }
    float values[3 * W * H];
    for (uint32_t i = 0; i < W * H; i++) {
        assert_true(kiln_film_aov(f, KILN_AOV_ALPHA, values) && values[i] == (float)(hits[i] / SPP));
        assert_true(kiln_film_aov(f, KILN_AOV_SAMPLES, values) && values[i] == SPP);
        assert_true(kiln_film_aov(f, KILN_AOV_DEPTH, values));
        assert_float_equal(values[i], hits[i] > 0 ? (float)(depth[i] / hits[i]) : 0, 1e-7f);
        assert_true(kiln_film_aov(f, KILN_AOV_ALBEDO, values));
        assert_float_equal(values[3 * i], (float)(albedo[i] / SPP), 1e-7f);
        assert_true(values[3 * i + 1] == (float)(hits[i] / SPP) && values[3 * i + 2] == 0);
        assert_true(kiln_film_aov(f, KILN_AOV_NORMAL, values) && values[3 * i + 1] == -(float)(hits[i] / SPP));
        assert_true(kiln_film_aov(f, KILN_AOV_ERROR, values));
        double sum = 0, count = 0, mean[3], variance[3];
        for (int y = (int)(i / W) - 2; y <= (int)(i / W) + 2; y++)
            for (int x = (int)(i % W) - 2; x <= (int)(i % W) + 2; x++) {
                if (x < 0 || y < 0 || x >= W || y >= H) continue;
                film_read_pixel(f, (size_t)(y * W + x), mean, variance);
                sum += (variance[0] + variance[1] + variance[2]) / 3, count++;
            }
        assert_float_equal(values[i], (float)sqrt(sum / count), 1e-6f);
    }
    assert_int_equal(kiln_film_spp(f), SPP);
    kiln_film_destroy(f);
}

static void films_are_checked(void **state) {
    (void)state;
    static const kiln_film_desc wrong[] = {
        {.width = 0, .height = 1}, {.width = 1, .height = 65537}, {.width = 9, .height = 9, .crop = {0, 0, 10, 9}},
        {.width = 9, .height = 9, .crop = {4, 4, 4, 5}}, {.width = 9, .height = 9, .aovs = 1u << KILN_AOV_COUNT}};
    for (int i = 0; i < 5; i++) {
        kiln_film *f;
        kiln_report *report = kiln_report_create();
        assert_false(kiln_film_create(&wrong[i], &f, report));
        assert_true(f == NULL && kiln_report_size(report) == 1);
        kiln_report_destroy(report);
    }
    kiln_film *plain = film_of(3, 2, 0), *rich = film_of(3, 2, 1u << KILN_AOV_DEPTH);
    float values[6];
    assert_false(kiln_film_aov(plain, KILN_AOV_DEPTH, values));
    assert_int_equal(kiln_film_size(&(kiln_film_desc){.width = 3, .height = 2}), kiln_film_bytes(plain));
    assert_true(kiln_film_bytes(rich) > kiln_film_bytes(plain));
    kiln_film_destroy(plain), kiln_film_destroy(rich), kiln_film_destroy(NULL);
}

/* A surface too bright for the film, or for a float, is counted at its first pixel and stays black; the rest is as
 * ever. */
static void what_does_not_fit_is_counted(void **state) {
    (void)state;
    static const struct { float factor, texture; kiln_discard cause; bool kept; } rows[] = {
        {0x1p37f, 1, KILN_DISCARD_COUNT, true}, {0x1p38f, 1, KILN_DISCARD_OVERFLOW, false},
        {1e30f, 1, KILN_DISCARD_OVERFLOW, false}, {1e30f, 1e20f, KILN_DISCARD_RADIANCE, false}};
    for (int i = 0; i < 4; i++) {
        scene_builder b = builder_make();
        float rgb[3] = {rows[i].texture, rows[i].texture, rows[i].texture};
        kiln_material m = diffuse_material(rows[i].factor, 1, 1), dim = diffuse_material(1, 1, 1);
        m.layers = dim.layers = KILN_LAYER_UNLIT;
        m.base_color.texture.image = add_image(&b, rgb, 1, 1);
        add_quad(&b, add_material(&b, &dim), (float[]){-2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0});
        add_quad(&b, add_material(&b, &m), (float[]){-.5f, -.5f, .1f, .5f, -.5f, .1f, .5f, .5f, .1f, -.5f, .5f, .1f});
        kiln_camera view = camera_at((float[]){0, 0, 3}, (float[]){0, 0, 0}, 40);
        view.projection = KILN_ORTHOGRAPHIC, view.xmag = view.ymag = 1;
        kiln_render_options o = {.spp = 4, .filter = KILN_PIXEL_BOX, .filter_width = 0.9};
        picture p = render(&b, &view, &o, 8, 8);
        for (int k = 0; k < KILN_DISCARD_COUNT; k++)
            assert_int_equal(p.stats.discarded[k], k == (int)rows[i].cause ? 4 * 4 * 4 : 0);
        if (!rows[i].kept) {
            assert_int_equal(p.stats.discarded_pixel[rows[i].cause][0], 2);
            assert_int_equal(p.stats.discarded_pixel[rows[i].cause][1], 2);
        }
        assert_true(p.rgb[3 * (4 * 8 + 4)] == (rows[i].kept ? rows[i].factor : 0) && p.rgb[0] == 1);
        assert_int_equal(kiln_film_samples(p.film), 8 * 8 * 4);
        picture_free(&p);
        builder_free(&b);
    }
}

/* A plane too far away for the film: its depth is counted and 0, everything else is as ever. */
static void aovs_that_do_not_fit_are_counted(void **state) {
    (void)state;
    static const struct { float size; bool fits; } rows[] = {{1e10f, true}, {1e12f, false}, {1e20f, false}};
    for (int i = 0; i < 3; i++) {
        float s = rows[i].size, depth[16], alpha[16];
        scene_builder b = builder_make();
        kiln_material m = diffuse_material(1, 1, 1);
        m.layers = KILN_LAYER_UNLIT;
        add_quad(&b, add_material(&b, &m), (float[]){-s, -s, 0, s, -s, 0, s, s, 0, -s, s, 0});
        must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
        kiln_camera view = camera_at((float[]){0, 0, 2 * s}, (float[]){0, 0, 0}, 40);
        kiln_renderer *r;
        must(kiln_renderer_create(b.scene, NULL, &r, b.report), b.report, "making a renderer");
        kiln_film_desc desc = {.width = 4, .height = 4, .aovs = 1u << KILN_AOV_DEPTH | 1u << KILN_AOV_ALPHA};
        picture p = render_with(r, &(kiln_render_options){.camera = &view, .spp = 4}, &desc, b.report);
        assert_true(kiln_film_aov(p.film, KILN_AOV_DEPTH, depth) && kiln_film_aov(p.film, KILN_AOV_ALPHA, alpha));
        assert_int_equal(p.stats.discarded[KILN_DISCARD_OVERFLOW], rows[i].fits ? 0 : 4 * 4 * 4);
        assert_float_equal(depth[5], rows[i].fits ? 2 * s : 0, 1e-5f * s);
        assert_true(alpha[5] == 1 && p.rgb[3 * 5] == 1);
        picture_free(&p);
        kiln_renderer_destroy(r);
        builder_free(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fixed_point_is_exact),         cmocka_unit_test(sums_do_not_depend_on_their_order),
        cmocka_unit_test(replicates_tell_the_variance), cmocka_unit_test(errors_follow_their_formula),
        cmocka_unit_test(known_variance_is_found),      cmocka_unit_test(the_background_does_not_count),
        cmocka_unit_test(aovs_are_averages),            cmocka_unit_test(films_are_checked),
        cmocka_unit_test(what_does_not_fit_is_counted), cmocka_unit_test(aovs_that_do_not_fit_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
