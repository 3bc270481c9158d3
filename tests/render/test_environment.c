/* The environment: where its texels lie, what a look-up says, and that it is sampled as its densities say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/light/light.h"
#include "render/world/environment.h"
#include "scene/transfer.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

typedef struct fixture {
    scene_builder b;
    world w;
} fixture;

/* rgb NULL: no picture, a constant. */
static fixture build(const float *rgb, uint32_t width, uint32_t height, double rotation_rad) {
    fixture f = {.b = builder_make()};
    kiln_decoding decoding;
    transfer_rec709(&decoding);
    kiln_environment desc = {.image = rgb ? add_image(&f.b, rgb, width, height) : 0, .transfer = KILN_TRANSFER_LINEAR,
                             .color = {1, 0.5f, 2}, .rotation_rad = rotation_rad};
    must(kiln_scene_set_environment(f.b.scene, &desc, f.b.report), f.b.report, "setting the environment");
    must(environment_build(&f.w, f.b.scene, &decoding, f.b.report), f.b.report, "building the environment");
    return f;
}
static void drop(fixture *f) {
    arena_free(&f->w.arena);
    builder_free(&f->b);
}

enum { WIDTH = 16, HEIGHT = 8 };

static const float *random_picture(void) {
    static float rgb[3 * WIDTH * HEIGHT];
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        for (uint32_t k = 0; k < 3; k++)
            rgb[3 * i + k] = i % 5 == 1 ? 0 : powf(unit_float(hash_pair(i, k)), 4) * 10; /* black texels, bright ones */
    return rgb;
}

static double texel_angle(int row, int width, int height) {
    return 2 * M_PI / width * (cos(M_PI * row / height) - cos(M_PI * (row + 1) / height));
}
static environment_value look(const environment *e, dvec3 d) {
    return environment_look_up(e, environment_place(v3((float)d.x, (float)d.y, (float)d.z)));
}
static double brightness(vec3 v) { return ((double)v.x + (double)v.y + (double)v.z) / 3; }
/* scene.h: u = 0.5 + atan2(z, x)/2π, v = acos(y)/π from the top. */
static dvec3 direction_of(double u, double v) {
    double phi = 2 * M_PI * (u - 0.5), theta = M_PI * v;
    return (dvec3){sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)};
}

static void texels_lie_where_the_formula_says(void **state) {
    (void)state;
    const float *rgb = random_picture();
    fixture f = build(rgb, WIDTH, HEIGHT, 0);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const float *t = rgb + 3 * (y * WIDTH + x);
            vec3 l = look(&f.w.lights.environment, direction_of((x + 0.5) / WIDTH, (y + 0.5) / HEIGHT)).radiance;
            float off = fabsf(l.x - t[0]) + fabsf(l.y - 0.5f * t[1]) + fabsf(l.z - 2 * t[2]);
            if (off > 2e-4f) fail_msg("texel %d %d: %g off", x, y, (double)off);
        }
    drop(&f);
}

/* Half-way between two centres lies the mean, round the seam too; at the poles the last row counts. */
static void look_ups_are_bilinear_and_wrap(void **state) {
    (void)state;
    const float *rgb = random_picture();
    fixture f = build(rgb, WIDTH, HEIGHT, 0);
    const environment *e = &f.w.lights.environment;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const float *a = rgb + 3 * (y * WIDTH + x), *b = rgb + 3 * (y * WIDTH + (x + 1) % WIDTH);
            const float *c = rgb + 3 * ((y + 1 < HEIGHT ? y + 1 : y) * WIDTH + x);
            float across = environment_look_up(e, (vec2){(float)(x + 1) / WIDTH, ((float)y + 0.5f) / HEIGHT}).radiance.x;
            float down = environment_look_up(e, (vec2){((float)x + 0.5f) / WIDTH, (float)(y + 1) / HEIGHT}).radiance.x;
            assert_true(fabsf(across - 0.5f * (a[0] + b[0])) < 1e-5f);
            assert_true(fabsf(down - 0.5f * (a[0] + c[0])) < 1e-5f);
        }
    for (int turn = -3; turn <= 3; turn++) /* whole turns make no difference */
        assert_true(fabsf(environment_look_up(e, (vec2){0.3f + (float)turn, 0.4f}).radiance.x -
                          environment_look_up(e, (vec2){0.3f, 0.4f}).radiance.x) < 1e-4f);
    drop(&f);
}

/* Counter-clockwise seen from above: what was ahead of +X goes to −Z. */
static void rotation_turns_the_surroundings(void **state) {
    (void)state;
    float rgb[3 * WIDTH * HEIGHT] = {0};
    int x = WIDTH / 2, y = HEIGHT / 2; /* a texel of u just above 0.5: d near +X */
    for (int k = 0; k < 3; k++) rgb[3 * (y * WIDTH + x) + k] = rgb[3 * (y * WIDTH + x - 1) + k] = 100;
    for (int quarter = 0; quarter < 4; quarter++) {
        fixture f = build(rgb, WIDTH, HEIGHT, quarter * M_PI / 2);
        const environment *e = &f.w.lights.environment;
        static const dvec3 expected[4] = {{1, -0.2, 0}, {0, -0.2, -1}, {-1, -0.2, 0}, {0, -0.2, 1}};
        for (int i = 0; i < 4; i++) {
            float seen = look(e, d3_normalize(expected[i])).radiance.x;
            assert_true(i == quarter ? seen > 90 : seen == 0);
        }
        light l = {.kind = LIGHT_ENVIRONMENT};
        environment_pick(e, (vec2){0.5f, 0.5f}, 0.5f, &l);
        light_sampled s = light_sample_environment(&l);
        dvec3 wi = {(double)s.wi.x, (double)s.wi.y, (double)s.wi.z};
        assert_true(d3_dot(wi, d3_normalize(expected[quarter])) > 0.9);
        drop(&f);
    }
}

/* Turns are counted in double: a float of a hundred million radians would have no angle left. */
static void many_turns_are_none(void **state) {
    (void)state;
    const double whole = 2 * M_PI * 16777216, rest = 1.25;
    fixture once = build(random_picture(), WIDTH, HEIGHT, rest);
    fixture often = build(random_picture(), WIDTH, HEIGHT, whole + rest);
    fixture back = build(random_picture(), WIDTH, HEIGHT, rest - whole);
    float expected = once.w.lights.environment.rotation_turns;
    assert_true(fabs((double)expected - rest / (2 * M_PI)) < 1e-7);
    assert_true(fabsf(often.w.lights.environment.rotation_turns - expected) < 1e-7f);
    assert_true(fabsf(back.w.lights.environment.rotation_turns - expected) < 1e-7f);
    drop(&once);
    drop(&often);
    drop(&back);
}

/* Small bright disks at both poles of a fine picture: where they are is known to a fraction of a row, and what is
 * picked gives their irradiance. */
static void poles_are_precise(void **state) {
    (void)state;
    enum { ACROSS = 4, DOWN = 4096, BRIGHT = 3, DRAWS = 100000, STEPS = 100000 };
    static float rgb[3 * ACROSS * DOWN];
    for (int i = 0; i < 3 * ACROSS * BRIGHT; i++) rgb[i] = rgb[3 * ACROSS * DOWN - 1 - i] = 1e6f;
    fixture f = build(rgb, ACROSS, DOWN, 0);
    const environment *e = &f.w.lights.environment;
    for (int i = 1; i < 400; i++) {
        double row = 0.01 * i, v = row / DOWN;
        for (int pole = 0; pole < 2; pole++) {
            dvec3 d = direction_of(0.3, pole ? 1 - v : v);
            double found = (double)environment_place(v3((float)d.x, (float)d.y, (float)d.z)).y;
            double exact = pole ? 1 - v : v;
            if (fabs(found - exact) * DOWN > 1e-3) fail_msg("row %g from pole %d: %g", row, pole, found * DOWN);
        }
    }
    double exact = 0; /* ∫ L cos over one disk, rows blended linearly */
    for (int i = 0; i < STEPS; i++) {
        double row = (BRIGHT + 0.5) * (i + 0.5) / STEPS, theta = M_PI * row / DOWN;
        exact += 1e6 * fmin(BRIGHT + 0.5 - row, 1) * M_PI * sin(2 * theta) * M_PI / DOWN * (BRIGHT + 0.5) / STEPS;
    }
    tally above = {0}, below = {0};
    stream random = {8, 0};
    for (int n = 0; n < DRAWS; n++) {
        light l = {.kind = LIGHT_ENVIRONMENT};
        vec2 u = stream_pair(&random);
        environment_pick(e, u, stream_next(&random), &l);
        light_sampled s = light_sample_environment(&l);
        assert_true(fabsf(v3_length(s.wi) - 1) < 1e-6f);
        assert_true(fabsf(environment_look_up(e, environment_place(s.wi)).radiance.x - s.radiance.x) < 1e3f);
        tally_add(&above, (double)(fmaxf(s.wi.y, 0) * s.radiance.x / s.pdf));
        tally_add(&below, (double)(fmaxf(-s.wi.y, 0) * s.radiance.x / s.pdf));
    }
    if (normal_tail(fabs(above.mean - exact) / tally_error(&above)) < sidak(1e-3, 2) ||
        normal_tail(fabs(below.mean - exact) / tally_error(&below)) < sidak(1e-3, 2))
        fail_msg("%.4f ± %.4f from above, %.4f ± %.4f from below, expected %.4f", above.mean, tally_error(&above),
                 below.mean, tally_error(&below), exact);
    /* With the noise of which pole taken out: only the blending of rows is left. */
    if (fabs(above.mean + below.mean - 2 * exact) > 2e-3 * exact)
        fail_msg("%.4f from both sides, expected %.4f", above.mean + below.mean, 2 * exact);
    drop(&f);
}

static void densities_integrate_to_one(void **state) {
    (void)state;
    static const double rotations[] = {0, 1, -7};
    for (int r = 0; r < 3; r++) {
        fixture f = build(random_picture(), WIDTH, HEIGHT, rotations[r]);
        const environment *e = &f.w.lights.environment;
        double sum = 0, power = 0;
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                const float *t = e->texels + 4 * (y * WIDTH + x);
                sum += (double)t[3] * texel_angle(y, WIDTH, HEIGHT);
                assert_true(t[0] == 0 || t[3] > 0); /* what shines can be found */
            }
        if (fabs(sum - 1) > 1e-6) fail_msg("densities integrate to %.8f", sum);
        enum { N = 400 }; /* total: radiance, mean of the channels, over the sphere */
        for (int i = 0; i < N; i++)
            for (int j = 0; j < 2 * N; j++) {
                vec3 l = environment_look_up(e, (vec2){((float)j + 0.5f) / (2 * N), ((float)i + 0.5f) / N}).radiance;
                power += brightness(l) * sin(M_PI * (i + 0.5) / N) * M_PI / N * M_PI / N;
            }
        if (fabs((double)e->total - power) > 0.02 * power) fail_msg("total %g, integral %g", (double)e->total, power);
        drop(&f);
    }
}

/* A texel's density is its mean brightness, as look-ups see it, over the whole. */
static void densities_follow_brightness(void **state) {
    (void)state;
    fixture f = build(random_picture(), WIDTH, HEIGHT, 0);
    const environment *e = &f.w.lights.environment;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        enum { N = 16 };
        double mean = 0, density = (double)e->texels[4 * i + 3];
        for (int n = 0; n < N * N; n++) {
            vec2 place = {((float)(i % WIDTH) + ((float)(n % N) + 0.5f) / N) / WIDTH,
                          ((float)(i / WIDTH) + ((float)(n / N) + 0.5f) / N) / HEIGHT};
            mean += brightness(environment_look_up(e, place).radiance) / (N * N);
        }
        if (fabs(density * (double)e->total - mean) > 0.01 * mean + 1e-4)
            fail_msg("texel %d: density %g, brightness %g of %g", i, density, mean, (double)e->total);
    }
    drop(&f);
}

/* Texels are drawn as often as their densities say, and what is picked is what a look-up finds there, but for directions
 * that rounding carries over a texel's edge. */
static void picks_agree_with_look_ups(void **state) {
    (void)state;
    enum { DRAWS = 200000 };
    fixture f = build(random_picture(), WIDTH, HEIGHT, 2);
    const environment *e = &f.w.lights.environment;
    static double counts[WIDTH * HEIGHT], expected[WIDTH * HEIGHT];
    stream random = {3, 0};
    int strays = 0;
    for (int n = 0; n < DRAWS; n++) {
        light l = {.kind = LIGHT_ENVIRONMENT};
        vec2 u = stream_pair(&random);
        environment_pick(e, u, stream_next(&random), &l);
        light_sampled s = light_sample_environment(&l);
        vec2 place = environment_place(s.wi);
        environment_value v = environment_look_up(e, place);
        strays += v.pdf != s.pdf;
        assert_true(fabsf(v3_length(s.wi) - 1) < 1e-5f && s.pdf > 0 && isinf(s.distance) && !s.parallel);
        assert_true(v3_max(v3_abs(v3_sub(v.radiance, s.radiance))) < 1e-3f);
        float turned = place.x + e->rotation_turns;
        counts[(int)(place.y * HEIGHT) * WIDTH + (int)((turned - floorf(turned)) * WIDTH)]++;
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        expected[i] = DRAWS * (double)e->texels[4 * i + 3] * texel_angle(i / WIDTH, WIDTH, HEIGHT);
    assert_true(strays < DRAWS / 10000);
    double p = chi_square_p(counts, expected, WIDTH * HEIGHT);
    if (p < 1e-3) fail_msg("p = %g", p);
    drop(&f);
}

/* Irradiance of a surface, by light samples and by midpoints. Three normals: joint level 1e-3. */
static void irradiance_agrees(void **state) {
    (void)state;
    fixture f = build(random_picture(), WIDTH, HEIGHT, -1);
    const environment *e = &f.w.lights.environment;
    const vec3 normals[] = {v3(0, 1, 0), v3(0.6f, 0, 0.8f), v3(-0.48f, -0.6f, 0.64f)};
    for (int i = 0; i < 3; i++) {
        enum { N = 300, DRAWS = 100000 };
        double exact = 0;
        tally estimate = {0};
        stream random = {(uint32_t)i, 7};
        for (int a = 0; a < N; a++)
            for (int b = 0; b < 2 * N; b++) {
                dvec3 d = direction_of((b + 0.5) / (2 * N), (a + 0.5) / N);
                double cosine = d.x * (double)normals[i].x + d.y * (double)normals[i].y + d.z * (double)normals[i].z;
                exact += fmax(cosine, 0) * (double)look(e, d).radiance.y * sin(M_PI * (a + 0.5) / N) * M_PI / N * M_PI / N;
            }
        for (int n = 0; n < DRAWS; n++) {
            light l = {.kind = LIGHT_ENVIRONMENT};
            vec2 u = stream_pair(&random);
            environment_pick(e, u, stream_next(&random), &l);
            light_sampled s = light_sample_environment(&l);
            tally_add(&estimate, (double)(fmaxf(v3_dot(s.wi, normals[i]), 0) * s.radiance.y / s.pdf));
        }
        double off = fmax(fabs(estimate.mean - exact) - 1e-4 * exact, 0);
        if (normal_tail(off / tally_error(&estimate)) < sidak(1e-3, 3))
            fail_msg("normal %d: %.5f ± %.5f, midpoints say %.5f", i, estimate.mean, tally_error(&estimate), exact);
    }
    drop(&f);
}

static void a_constant_is_uniform(void **state) {
    (void)state;
    fixture f = build(NULL, 0, 0, 0);
    const environment *e = &f.w.lights.environment;
    stream random = {4, 0};
    double up = 0;
    for (int n = 0; n < 20000; n++) {
        light l = {.kind = LIGHT_ENVIRONMENT};
        vec2 u = stream_pair(&random);
        environment_pick(e, u, stream_next(&random), &l);
        light_sampled s = light_sample_environment(&l);
        assert_true(fabs((double)s.pdf * 4 * M_PI - 1) < 1e-5);
        assert_true(s.radiance.x == 1 && s.radiance.y == 0.5f && s.radiance.z == 2);
        up += s.wi.y > 0.5f; /* a quarter of the sphere */
    }
    assert_true(fabs(up - 5000) < 4 * sqrt(20000 * 0.25 * 0.75));
    drop(&f);
}

/* What is no radiance counts as black, and is warned of once; a black sky has no density at all. */
static void bad_texels_are_black(void **state) {
    (void)state;
    const float rgb[12] = {NAN, 1, 1, -1, INFINITY, 0, 1, 1, 1, 9e29f, 0, 2e38f};
    fixture f = build(rgb, 2, 2, 0);
    const environment *e = &f.w.lights.environment;
    for (int i = 0; i < 16; i++) assert_true(e->texels[i] >= 0 && e->texels[i] < INFINITY);
    assert_true(e->texels[0] == 0 && e->texels[4] == 0 && e->texels[5] == 0);
    assert_int_equal(kiln_report_size(f.b.report), 1);
    assert_true(e->texels[12] == 9e29f && e->texels[14] == 0);
    assert_true(isfinite(e->total));
    drop(&f);
    const float black[12] = {0};
    f = build(black, 2, 2, 0);
    assert_true(f.w.lights.environment.total == 0 && f.w.lights.environment.texels[3] == 0);
    drop(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_lie_where_the_formula_says), cmocka_unit_test(look_ups_are_bilinear_and_wrap),
        cmocka_unit_test(rotation_turns_the_surroundings),   cmocka_unit_test(many_turns_are_none),
        cmocka_unit_test(poles_are_precise),                 cmocka_unit_test(densities_integrate_to_one),
        cmocka_unit_test(densities_follow_brightness),
        cmocka_unit_test(picks_agree_with_look_ups),         cmocka_unit_test(irradiance_agrees),
        cmocka_unit_test(a_constant_is_uniform),             cmocka_unit_test(bad_texels_are_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
