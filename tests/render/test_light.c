/* Light kernels against closed forms, and how lights of a scene become records: units, power, choice. Monte Carlo
 * estimates are joint at the level of one false alarm in a thousand for each test; seeds are fixed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "render/light/light.h"
#include "render/light/parallelogram.h"
#include "render/world/world.h"
#include "scene/transfer.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

enum { DRAWS = 50000 };
#define LEVEL 1e-3

static dvec3 to_double(vec3 v) { return (dvec3){(double)v.x, (double)v.y, (double)v.z}; }

static light triangle_light(vec3 a, vec3 b, vec3 c, float two_sided) {
    light l = {.kind = LIGHT_TRIANGLE, .position = a, .e1 = v3_sub(b, a), .e2 = v3_sub(c, a), .radiance = {1, 2, 3},
               .two_sided = two_sided, .error = 1e-6f};
    vec3 n = v3_cross(l.e1, l.e2);
    l.area = 0.5f * v3_length(n);
    l.axis = v3_normalize(n);
    return l;
}

/* Lambert's formula (1760): irradiance by a uniform polygon above the horizon is L/2 Σ angle · (edge normal · n). */
static double lambert(const dvec3 v[3], dvec3 p, dvec3 n) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        dvec3 a = d3_normalize(d3_sub(v[i], p)), b = d3_normalize(d3_sub(v[(i + 1) % 3], p)), c = d3_cross(a, b);
        sum += atan2(d3_length(c), d3_dot(a, b)) * d3_dot(d3_normalize(c), n);
    }
    return 0.5 * fabs(sum);
}

/* Van Oosterom and Strackee 1983. */
static double solid_angle(const dvec3 v[3], dvec3 p) {
    dvec3 a = d3_normalize(d3_sub(v[0], p)), b = d3_normalize(d3_sub(v[1], p)), c = d3_normalize(d3_sub(v[2], p));
    return 2 * atan2(fabs(d3_dot(a, d3_cross(b, c))), 1 + d3_dot(a, b) + d3_dot(b, c) + d3_dot(c, a));
}

static void assert_near(const char *what, int row, const tally *t, double exact, double tests) {
    const double rounding = 1e-5 * exact; /* solid angles have no other error */
    double off = fmax(fabs(t->mean - exact) - rounding, 0);
    if (off > 0 && normal_tail(off / tally_error(t)) < sidak(LEVEL, tests))
        fail_msg("%s %d: %.6f ± %.6f instead of %.6f", what, row, t->mean, tally_error(t), exact);
}

static void triangles_light_as_lambert_says(void **state) {
    (void)state;
    stream random = {21, 0};
    enum { ROWS = 12 };
    for (int row = 0; row < ROWS; row++) {
        vec3 corner[3], p = v3(0, 0, 0), n = v3(0, 0, 1);
        for (int k = 0; k < 3; k++)
            corner[k] = v3(stream_between(&random, -1, 1), stream_between(&random, -1, 1), stream_between(&random, 0.3f, 2));
        light l = triangle_light(corner[0], corner[1], corner[2], 1);
        dvec3 v[3] = {to_double(corner[0]), to_double(corner[1]), to_double(corner[2])};
        tally irradiance = {0}, angle = {0};
        for (int i = 0; i < DRAWS; i++) {
            light_sampled s = light_sample(KIND(LIGHT_TRIANGLE), &l, p, stream_pair(&random));
            tally_add(&irradiance, s.pdf > 0 ? (double)(s.radiance.x * fmaxf(v3_dot(s.wi, n), 0) / s.pdf) : 0);
            tally_add(&angle, s.pdf > 0 ? 1 / (double)s.pdf : 0);
        }
        assert_near("irradiance", row, &irradiance, lambert(v, (dvec3){0, 0, 0}, (dvec3){0, 0, 1}), 2 * ROWS);
        assert_near("solid angle", row, &angle, solid_angle(v, (dvec3){0, 0, 0}), 2 * ROWS);
    }
}

/* Densities of a light sample and of a hit at the same place are one; the target is on the light, this side of it; only
 * two-sided triangles shine backwards. */
static void triangle_samples_are_consistent(void **state) {
    (void)state;
    stream random = {22, 0};
    for (int i = 0; i < 20000; i++) {
        vec3 a = stream_direction(&random), b = stream_direction(&random), c = stream_direction(&random);
        vec3 p = v3_scale(stream_direction(&random), 2);
        light l = triangle_light(a, b, c, (float)(i & 1));
        if (!(l.area > 0.05f)) continue;
        light_sampled s = light_sample(KIND(LIGHT_TRIANGLE), &l, p, stream_pair(&random));
        float cosine = -v3_dot(s.wi, l.axis);
        bool shines = l.two_sided > 0.5f || cosine > 0;
        assert_true(!s.parallel && fabsf(v3_length(s.wi) - 1) < 1e-5f && (s.pdf > 0) == shines);
        if (!shines || fabsf(cosine) < 1e-3f) continue;
        float of_hit = light_triangle_pdf(&l, p, s.distance, cosine);
        if (fabsf(of_hit - s.pdf) > 1e-4f * s.pdf) fail_msg("densities %g and %g", (double)s.pdf, (double)of_hit);
        vec3 off = v3_sub(s.target, v3_madd(p, s.distance, s.wi));
        float height = v3_dot(v3_sub(s.target, l.position), l.axis) * (cosine > 0 ? 1.0f : -1.0f);
        assert_true(v3_length(off) < 1e-5f && height > 0 && height < 2e-6f);
    }
}

/* Numerically: how much of each of 4 × 4 cells of (b, c) the point sees, and of all. */
static double cells_seen(const light *l, vec3 p, double cells[16]) {
    enum { STEPS = 200 };
    double sum = 0, area = (double)v3_length(v3_cross(l->e1, l->e2));
    for (int i = 0; i < 16; i++) cells[i] = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            float b = ((float)i + 0.5f) / STEPS, c = ((float)j + 0.5f) / STEPS;
            vec3 d = v3_sub(v3_madd(v3_madd(l->position, b, l->e1), c, l->e2), p);
            double d2 = (double)v3_dot(d, d), seen = fabs((double)v3_dot(d, l->axis)) / (d2 * sqrt(d2));
            if (l->quad < 0.5f && i + j >= STEPS) continue;
            cells[i * 4 / STEPS * 4 + j * 4 / STEPS] += l->quad < 0.5f && i + j == STEPS - 1 ? 0.5 * seen : seen;
            sum += l->quad < 0.5f && i + j == STEPS - 1 ? 0.5 * seen : seen;
        }
    for (int i = 0; i < 16; i++) cells[i] /= sum;
    return sum * area / (STEPS * STEPS);
}

/* Triangles and parallelograms of all sizes, near and far: the density is one over the solid angle, samples follow it,
 * lie on the light, and a hit there is given the same bits. */
static void solid_angles_are_sampled_evenly(void **state) {
    (void)state;
    enum { ROWS = 60, SAMPLES = 4000 };
    stream random = {25, 0};
    int by_angle = 0;
    for (int row = 0; row < ROWS; row++) {
        float size = powf(10, stream_between(&random, -1.5f, 1)), two = 1;
        vec3 a = v3_scale(stream_direction(&random), 0.2f + stream_next(&random)), p = v3(0, 0, 0);
        vec3 b = v3_madd(a, size, stream_direction(&random)), c = v3_madd(a, size, stream_direction(&random));
        light l = triangle_light(a, b, c, two);
        if (row & 1) l.quad = 1, l.area *= 2;
        light_view v = light_see(&l, p);
        double angle = (double)v.angle[0] + (double)v.angle[1], cells[16], counts[16] = {0};
        if (!(angle > 0) || fabs((double)v.height) < 0.03 * (double)size) continue; /* grids are too coarse for the last */
        by_angle++;
        double seen = cells_seen(&l, p, cells);
        if (fabs(seen / angle - 1) > 0.01) fail_msg("row %d: %g sr instead of %g", row, angle, seen);
        for (int i = 0; i < SAMPLES; i++) {
            light_sampled s = light_sample(KIND(LIGHT_TRIANGLE), &l, p, stream_pair(&random));
            vec2 at = light_triangle_place(&l, s.target);
            vec3 on = v3_madd(v3_madd(l.position, at.x, l.e1), at.y, l.e2);
            if (v3_length(v3_sub(on, s.target)) > 1e-3f * size) fail_msg("row %d: a sample lies %g beside a light of %g", row, (double)v3_length(v3_sub(on, s.target)), (double)size);
            assert_true(l.quad > 0.5f || at.x + at.y < 1.001f);
            assert_true(s.pdf == light_triangle_pdf(&l, p, 7, 0.5f));
            counts[(int)fminf(4 * at.x, 3) * 4 + (int)fminf(4 * at.y, 3)]++;
        }
        for (int i = 0; i < 16; i++) cells[i] *= SAMPLES;
        if (chi_square_p(counts, cells, 16) < sidak(LEVEL, ROWS)) fail_msg("row %d: %g sr are not sampled evenly", row, angle);
    }
    assert_true(by_angle > ROWS / 2);
}

/* From everywhere, of everything: numbers stay finite, a hit has the density of a sample, or none at all. */
static void any_triangle_is_survived(void **state) {
    (void)state;
    stream random = {26, 0};
    for (int i = 0; i < 20000; i++) {
        float size = powf(10, stream_between(&random, -12, 12)), away = powf(10, stream_between(&random, -12, 12));
        vec3 a = v3_scale(stream_direction(&random), size), b = v3_scale(stream_direction(&random), size);
        vec3 c = i % 5 == 0 ? v3_scale(b, 0.5f) : i % 5 == 1 ? a : v3_scale(stream_direction(&random), size);
        light l = triangle_light(a, b, c, (float)(i & 1));
        if (!(l.area > 0)) l.axis = v3_splat(0), l.area = 0;
        if (i & 2) l.quad = 1, l.area *= 2;
        vec3 on = v3_madd(v3_madd(a, stream_next(&random), l.e1), stream_next(&random), l.e2); /* in its plane */
        vec3 p = i % 3 == 0 ? v3_scale(stream_direction(&random), away) : i % 3 == 1 ? on : a;
        light_sampled s = light_sample(KIND(LIGHT_TRIANGLE), &l, p, stream_pair(&random));
        assert_true(s.pdf >= 0 && s.pdf < INFINITY && isfinite(s.wi.x + s.wi.y + s.wi.z));
        vec2 at = light_triangle_place(&l, s.target);
        assert_true(at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1);
        float cosine = -v3_dot(s.wi, l.axis), hit = light_triangle_pdf(&l, p, s.distance, cosine);
        if (s.pdf > 0 && !(fabsf(hit / s.pdf - 1) < 1e-3f)) fail_msg("%d: %g drawn, %g hit", i, (double)s.pdf, (double)hit);
    }
}

static void pairs_make_parallelograms(void **state) {
    (void)state;
    const vec3 o = {0, 0, 1}, x = {2, 0, 1}, y = {0.5f, 3, 1}, both = {2.5f, 3, 1};
    const vec3 first[3] = {x, y, o}, second[3] = {y, x, both}, same[3] = {x, y, both};
    int apex;
    float off;
    assert_true(parallelogram_make(first, second, &apex, &off) && apex == 2 && off == 0);
    assert_false(parallelogram_make(first, same, &apex, &off)); /* its winding is another */
    for (int k = 0; k < 2; k++) {
        const vec3 moved = v3_add(both, k ? v3(0, 0, 0x1p-22f) : v3(0.001f, 0, 0)), third[3] = {y, x, moved};
        assert_int_equal(parallelogram_make(first, third, &apex, &off), k);
    }
}

static void degenerate_triangles_give_nothing(void **state) {
    (void)state;
    vec3 o = v3(0, 0, 0), x = v3(1, 0, 0), y = v3(0, 1, 0);
    light l = triangle_light(o, x, y, 1);
    assert_true(light_sample(KIND(LIGHT_TRIANGLE), &l, o, (vec2){0, 0}).pdf == 0); /* from on the light */
    assert_true(light_sample(KIND(LIGHT_TRIANGLE), &l, v3(2, 0.5f, 0), (vec2){0.5f, 0.5f}).pdf == 0); /* edge-on */
    l.area = 0;
    light_sampled s = light_sample(KIND(LIGHT_TRIANGLE), &l, v3(0, 0, 1), (vec2){0.5f, 0.5f});
    assert_true(s.pdf == 0 && isfinite(s.wi.x) && isfinite(s.target.x));
    assert_true(light_triangle_pdf(&l, v3(0, 0, 1), 1, 1) == 0);
    l.area = 0.5f;
    assert_true(light_triangle_pdf(&l, v3(2, 0.5f, 0), 1, 0) == 0);
}

/* I cos/d² at the foot of a slanted ray, and the spot's smooth cone (KHR_lights_punctual). */
static void points_and_spots_follow_inverse_squares(void **state) {
    (void)state;
    stream random = {23, 0};
    const double inner = 0.3, outer = 0.6, scale = 1 / fmax(0.001, cos(inner) - cos(outer)), offset = -cos(outer) * scale;
    light spot = {.kind = LIGHT_SPOT, .position = {1, 2, 3}, .axis = {0, -1, 0}, .radiance = {5, 6, 7},
                  .spot_scale = (float)scale, .spot_offset = (float)offset}, point = spot;
    point.kind = LIGHT_POINT;
    for (int i = 0; i < 2000; i++) {
        vec3 p = v3_add(spot.position, v3_scale(stream_direction(&random), stream_between(&random, 0.01f, 50)));
        dvec3 d = d3_sub(to_double(spot.position), to_double(p));
        double d2 = d3_dot(d, d), cosine = d.y / sqrt(d2), edge = fmin(fmax(cosine * scale + offset, 0), 1);
        light_sampled a = light_sample(KIND(LIGHT_POINT) | KIND(LIGHT_SPOT), &point, p, (vec2){0, 0});
        light_sampled b = light_sample(KIND(LIGHT_POINT) | KIND(LIGHT_SPOT), &spot, p, (vec2){0, 0});
        assert_true(a.parallel && a.pdf == 1 && fabs((double)a.distance - sqrt(d2)) < 1e-5 * sqrt(d2));
        double along = (double)v3_dot(a.wi, v3_normalize(v3_sub(spot.position, p)));
        assert_true(fabs((double)a.radiance.y * d2 - 6) < 1e-4 && fabs(along - 1) < 1e-6);
        assert_true(fabs((double)b.radiance.y * d2 - 6 * edge * edge) < 2e-3 && b.parallel && b.pdf == 1);
    }
    light_sampled at = light_sample(KIND(LIGHT_POINT), &point, point.position, (vec2){0, 0});
    assert_true(at.pdf == 0 && isfinite(at.radiance.x));
}

/* A sun of any size: directions within its disk, the density that of the disk, and what a surface that faces it receives
 * is the illuminance. */
static void suns_give_their_illuminance(void **state) {
    (void)state;
    static const double angles[] = {0, 1e-5, 0.0093, 0.5, 3.0};
    for (int row = 0; row < 5; row++) {
        scene_builder b = builder_make();
        kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[]){3, 4, 0}, (float[]){0, 0, 0}, 1000);
        sun.angle_rad = (float)angles[row];
        add_light(&b, &sun);
        must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
        kiln_decoding decoding;
        transfer_rec709(&decoding);
        world *w;
        must(world_create(b.scene, &(world_build_options){&decoding, KILN_TEXTURES_MIP, .threads = 1}, &w, b.report), b.report, "building the world");
        const light *l = &w->lights.lights[0];
        vec3 toward = v3(0.6f, 0.8f, 0);
        tally illuminance = {0};
        stream random = {24, 0};
        for (int i = 0; i < DRAWS; i++) {
            light_sampled s = light_sample(w->lights.kinds, l, v3(1, 1, 1), stream_pair(&random));
            double off = 2 * asin(0.5 * (double)v3_length(v3_sub(s.wi, toward)));
            assert_true(off <= 0.5 * angles[row] + 1e-6 && isinf(s.distance) && s.parallel == (row == 0));
            double disk = 2 * M_PI * (1 - cos(0.5 * (double)sun.angle_rad)), rounding = row == 1 ? 0.1 : 1e-4;
            if (row) assert_true(fabs((double)s.pdf * disk - 1) < rounding);
            tally_add(&illuminance, (double)(s.radiance.x / s.pdf) * (double)v3_dot(s.wi, toward));
        }
        if (fabs(illuminance.mean - 1000) > 1e-3 * 1000 + 5 * tally_error(&illuminance))
            fail_msg("angle %g: illuminance %g", angles[row], illuminance.mean);
        assert_int_equal(w->lights.distant_count, row > 0);
        world_destroy(w);
        builder_free(&b);
    }
}

/* By power: half of the choices in proportion to what a light gives off, in watts of the same scene, parallel lights by
 * what passes through the scene's disk; half alike among emitters; the two triangles of a lamp are one light.
 * Uniformly: each as often. Points alone: those that nothing can hit. */
static void lights_are_chosen_by_power(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(0, 0, 0);
    for (int k = 0; k < 3; k++) m.emission.value[k] = 3;
    /* 4 × 6 m at x = ±2, y = ±3: a scene of radius √13. */
    add_quad(&b, add_material(&b, &m), (const float[]){-2, -3, 0, 2, -3, 0, 2, 3, 0, -2, 3, 0});
    kiln_light spot = light_at(KILN_LIGHT_SPOT, (float[]){0, 0, 0}, (float[]){1, 0, 0}, 40);
    spot.outer_cone_rad = 1, spot.inner_cone_rad = 0.2f;
    kiln_light point = light_at(KILN_LIGHT_POINT, (float[]){0, 1, 0}, (float[]){1, 0, 0}, 50);
    kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[]){0, 1, 0}, (float[]){1, 0, 0}, 7), beam = sun;
    sun.angle_rad = 0.02f;
    add_light(&b, &spot), add_light(&b, &point), add_light(&b, &sun), add_light(&b, &beam);
    set_environment(&b, 0, 0.5f, 0.5f, 0.5f);
    must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
    kiln_decoding decoding;
    transfer_rec709(&decoding);
    world *w;
    must(world_create(b.scene, &(world_build_options){&decoding, KILN_TEXTURES_MIP, .threads = 1}, &w, b.report), b.report, "building the world");
    const double pi = M_PI, disk = 13 * pi;
    const double power[] = {pi * 24 * 3, 2 * pi * (1 - cos(1)) * 40, 4 * pi * 50, disk * 7, disk * 7,
                            disk * 4 * pi * 0.5};
    const bool hittable[] = {1, 0, 0, 1, 0, 1};
    double sum = 0;
    for (int i = 0; i < 6; i++) sum += power[i];
    assert_int_equal(w->lights.count, 6);
    for (uint32_t i = 0; i < 6; i++) {
        double by_power = (double)distribution_probability(w->lights.cdf[CHOOSE_BY_POWER], i);
        double uniform = (double)distribution_probability(w->lights.cdf[CHOOSE_UNIFORMLY], i);
        double alone = (double)distribution_probability(w->lights.cdf[CHOOSE_POINTS], i);
        double expected = 0.5 * power[i] / sum + 0.5 / 6;
        if (fabs(by_power - expected) > 1e-5 * by_power + 1e-6)
            fail_msg("light %u: chosen with %.7f instead of %.7f", i, by_power, expected);
        assert_true(fabs(uniform - 1.0 / 6) < 1e-6 && fabs(alone - (hittable[i] ? 0 : 1.0 / 3)) < 1e-6);
    }
    world_destroy(w);
    builder_free(&b);
}

/* Power heuristic: weights of two strategies sum to 1. */
static void weights_sum_to_one(void **state) {
    (void)state;
    static const float pdfs[] = {1e-10f, 0.01f, 1, 7, 1e10f};
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            double a = (double)pdfs[i], b = (double)pdfs[j];
            double w = (double)mis_weight(pdfs[i], pdfs[j]), other = (double)mis_weight(pdfs[j], pdfs[i]);
            assert_true(fabs(w + other - 1) < 1e-6 && fabs(w - a * a / (a * a + b * b)) < 1e-6);
        }
    assert_true(mis_weight(1, 0) == 1 && mis_weight(0, 1) == 0 && mis_weight(0, 0) == 0 && mis_weight(1, INFINITY) == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_light_as_lambert_says),   cmocka_unit_test(triangle_samples_are_consistent),
        cmocka_unit_test(degenerate_triangles_give_nothing), cmocka_unit_test(points_and_spots_follow_inverse_squares),
        cmocka_unit_test(lights_are_chosen_by_power),         cmocka_unit_test(solid_angles_are_sampled_evenly),
        cmocka_unit_test(any_triangle_is_survived),          cmocka_unit_test(pairs_make_parallelograms),
        cmocka_unit_test(suns_give_their_illuminance),       cmocka_unit_test(weights_sum_to_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
