/* Warps: where they land, with which density. Chi-square tests at a joint level of one false alarm in a thousand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/sample/warp.h"
#include "tests/render/statistics.h"

enum { SIDE = 12, CELLS = SIDE * SIDE, DRAWS = 100000 };
#define LEVEL 1e-3

/* For each warp its inverse: where in the unit square a uniform point must have come from. */
static vec2 from_disk(vec2 u) {
    vec2 d = warp_disk(u);
    double turns = atan2((double)d.y, (double)d.x) / (2 * M_PI);
    assert_true(d.x * d.x + d.y * d.y <= 1.000001f);
    return (vec2){d.x * d.x + d.y * d.y, (float)(turns - floor(turns))};
}
/* The cosine's density makes sin² θ uniform. */
static vec2 from_cosine(vec2 u) {
    vec3 d = warp_cosine(u);
    double turns = atan2((double)d.y, (double)d.x) / (2 * M_PI);
    assert_true(d.z > 0 && fabsf(v3_length(d) - 1) < 1e-6f);
    return (vec2){1 - d.z * d.z, (float)(turns - floor(turns))};
}
#define WIDE_CONE 0.7f
static vec2 from_cone(vec2 u) {
    vec3 d = warp_cone(u, WIDE_CONE);
    double turns = atan2((double)d.y, (double)d.x) / (2 * M_PI);
    assert_true(d.z >= 1 - WIDE_CONE - 1e-6f && fabsf(v3_length(d) - 1) < 1e-6f);
    return (vec2){(1 - d.z) / WIDE_CONE, (float)(turns - floor(turns))};
}
/* On a triangle the sum of two weights has density 2 s, and their shares are uniform. */
static vec2 from_triangle(vec2 u) {
    vec2 b = warp_triangle(u);
    float s = b.x + b.y;
    assert_true(b.x >= 0 && b.y >= 0 && s <= 1.000001f);
    return (vec2){s * s, s > 0 ? b.y / s : 0};
}

static void warps_have_their_densities(void **state) {
    (void)state;
    static const struct { const char *name; vec2 (*back)(vec2); } rows[] = {
        {"disk", from_disk}, {"cosine", from_cosine}, {"cone", from_cone}, {"triangle", from_triangle}};
    for (size_t i = 0; i < 4; i++) {
        double counts[CELLS] = {0}, expected[CELLS];
        stream random = {(uint32_t)i, 0};
        for (int n = 0; n < DRAWS; n++) {
            vec2 u = rows[i].back(stream_pair(&random));
            int x = (int)(u.x * SIDE), y = (int)(u.y * SIDE);
            counts[(x < SIDE ? x : SIDE - 1) * SIDE + (y < SIDE ? y : SIDE - 1)]++;
        }
        for (int c = 0; c < CELLS; c++) expected[c] = (double)DRAWS / CELLS;
        double p = chi_square_p(counts, expected, CELLS);
        if (p < sidak(LEVEL, 4)) fail_msg("%s: p = %g", rows[i].name, p);
    }
}

/* Neighbours stay neighbours, so that stratified points do: each warp is undone by its inverse. */
static void warps_keep_strata(void **state) {
    (void)state;
    stream random = {9, 0};
    for (int n = 0; n < 10000; n++) {
        vec2 u = {stream_between(&random, 0.01f, 0.99f), stream_between(&random, 0.01f, 0.99f)};
        vec2 back[4] = {from_disk(u), from_cosine(u), from_cone(u), from_triangle(u)};
        for (int i = 0; i < 4; i++)
            if (fabsf(back[i].x - u.x) > 1e-5f || fabsf(back[i].y - u.y) > 2e-5f)
                fail_msg("warp %d: %g %g came from %g %g", i, (double)back[i].x, (double)back[i].y, (double)u.x, (double)u.y);
    }
}

static void corners_are_harmless(void **state) {
    (void)state;
    const float last = 0x1.fffffep-1f, edges[] = {0, last, 0.5f};
    for (int i = 0; i < 9; i++) {
        vec2 u = {edges[i / 3], edges[i % 3]};
        assert_true(warp_cosine(u).z > 0);
        (void)from_disk(u), (void)from_cosine(u), (void)from_cone(u), (void)from_triangle(u);
    }
    assert_true(warp_cosine((vec2){0, 0}).z == 1.0f);
}

/* A sun of half a millionth of a turn: 1 − cos would be lost in a cosine, but not here. */
static void small_cones_keep_their_size(void **state) {
    (void)state;
    for (float h = 1e-12f; h < 1e-2f; h *= 10) {
        vec3 edge = warp_cone((vec2){0x1.fffffep-1f, 0.25f}, h);
        double radius = hypot((double)edge.x, (double)edge.y), expected = sqrt((double)h * (2 - (double)h));
        assert_true(fabs(radius - expected) < 1e-5 * expected);
    }
    vec3 straight = warp_cone((vec2){0.7f, 0.3f}, 0);
    assert_true(straight.x == 0 && straight.y == 0 && straight.z == 1);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(warps_have_their_densities),
        cmocka_unit_test(warps_keep_strata),
        cmocka_unit_test(corners_are_harmless),
        cmocka_unit_test(small_cones_keep_their_size),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
