/* Rays and triangles: answers do not depend on how rays are packed, occlusion agrees with the closest hit, and both
 * agree with a search through all triangles in double. Seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/render/rays.h"

/* Copies that are together more triangles than are written out, so that Embree places them. */
enum { WAVES = 128, COPIES = 33 };

static int set_up(void **state) {
    scene_builder b = builder_make();
    stream s = {1, 0};
    add_copies(&b, add_waves(&b, 0, WAVES), COPIES, &s);
    add_slivers(&b, &s, 500, 1e-5f);
    add_sphere(&b, 0, (float[]){0.4f, 0.2f, -0.3f}, 0.3f, 32, 0);
    add_box(&b, 0, (float[]){-0.8f, -0.5f, -0.2f}, (float[]){-0.5f, -0.2f, 0.6f});
    world *w = build_world(&b);
    assert_int_equal(w->instance_count, COPIES + 1);
    builder_free(&b);
    *state = w;
    return 0;
}
static int tear_down(void **state) {
    world_destroy(*state);
    return 0;
}

/* A million rays: one that is not stopped on the way to infinity hits nothing; one that hits something sees up to a
 * little before it and no further than a little behind. */
static void occlusion_agrees_with_the_closest_hit(void **state) {
    enum { ALL = 1000000, SOME = 200000 };
    const world *w = *state;
    rays r = rays_random(ALL, 0.7f * w->radius, 2);
    rays_closest(w, &r, NULL, r.count);
    rays_visible(w, &r);
    uint32_t hits = 0, bad = 0;
    for (uint32_t i = 0; i < r.count; i++) {
        bool hit = r.triangle[i] < TRIANGLE_REFUSED;
        hits += hit;
        bad += hit != (r.visible[i] == RAY_STOPPED) || (hit ? !(r.t[i] > 0) : r.triangle[i] != TRIANGLE_NONE);
        r.tfar[i] = hit ? r.t[i] * (1 - 1e-5f) : 1e30f;
    }
    assert_true(hits > r.count / 20 && hits < r.count * 9 / 10);
    r.count = SOME;
    rays_visible(w, &r);
    for (uint32_t i = 0; i < r.count; i++) {
        bad += r.visible[i] != RAY_REACHES;
        r.tfar[i] = r.triangle[i] < TRIANGLE_REFUSED ? r.t[i] * (1 + 1e-5f) : INFINITY;
    }
    rays_visible(w, &r);
    for (uint32_t i = 0; i < r.count; i++) bad += (r.visible[i] == RAY_STOPPED) != (r.triangle[i] < TRIANGLE_REFUSED);
    assert_int_equal(bad, 0);
    assert_int_equal(r.counts.rays, 2 * (ALL + SOME));
    assert_int_equal(r.counts.refused, 0);
    rays_free(&r);
}

/* The same bits alone, in a full packet, among rays that were not asked for, and beside refused ones. */
static void packing_changes_nothing(void **state) {
    const world *w = *state;
    rays all = rays_random(100000, 0.6f * w->radius, 3), one = rays_random(100000, 0.6f * w->radius, 3);
    rays_closest(w, &all, NULL, all.count);
    uint32_t *list = calloc(all.count, sizeof *list), listed = 0;
    for (uint32_t i = 0; i < one.count; i++) {
        one.triangle[i] = 12345;
        if (i % 3 == 0) rays_closest(w, &one, &i, 1);
        else if (i % 3 == 1) list[listed++] = i;
        else one.dx[i] = i & 1 ? NAN : 0;
        if (i % 3 == 2 && i % 6 == 5) list[listed++] = i;
    }
    rays_closest(w, &one, list, listed);
    for (uint32_t i = 0; i < one.count; i++) {
        if (i % 3 == 2) continue;
        bool same = one.triangle[i] == all.triangle[i] && one.instance[i] == all.instance[i] && one.t[i] == all.t[i];
        if (all.triangle[i] < TRIANGLE_REFUSED) same = same && one.u[i] == all.u[i] && one.v[i] == all.v[i];
        if (!same) fail_msg("ray %u: triangle %u at %.9g instead of %u at %.9g", i, one.triangle[i], (double)one.t[i],
                            all.triangle[i], (double)all.t[i]);
    }
    for (uint32_t i = 2; i < one.count; i += 6) assert_int_equal(one.triangle[i], 12345); /* nobody asked */
    free(list);
    rays_free(&all);
    rays_free(&one);
}

static dvec3 to_double(vec3 v) { return (dvec3){(double)v.x, (double)v.y, (double)v.z}; }

static dvec3 corner(const world *w, uint32_t triangle, uint32_t instance, int k) {
    const float *p = w->vertices[w->triangles[3 * (size_t)triangle + (size_t)k]].p, *m = w->instances[instance].m;
    double x[3];
    for (int i = 0; i < 3; i++)
        x[i] = (double)m[4 * i] * (double)p[0] + (double)m[4 * i + 1] * (double)p[1] +
               (double)m[4 * i + 2] * (double)p[2] + (double)m[4 * i + 3];
    return d3_load(x);
}

/* Distance to a triangle after Möller and Trumbore 1997 in double; negative: missed. *margin: how far from an edge, by
 * the smallest barycentric coordinate and the smallest height. */
static double distance_to(dvec3 o, dvec3 d, dvec3 a, dvec3 b, dvec3 c, double *margin) {
    dvec3 e1 = d3_sub(b, a), e2 = d3_sub(c, a), p = d3_cross(d, e2), s = d3_sub(o, a), q = d3_cross(s, e1);
    double det = d3_dot(e1, p), u = d3_dot(s, p) / det, v = d3_dot(d, q) / det;
    double inside = fmin(fmin(u, v), 1 - u - v), longest = fmax(d3_length(e1), d3_length(e2));
    *margin = inside * d3_length(d3_cross(e1, e2)) / longest;
    return inside >= 0 ? d3_dot(e2, q) / det : -1;
}

/* What is said to be hit is hit there: distance and barycentric place, in double, through the copy's transform. */
static void hits_lie_on_their_triangles(void **state) {
    const world *w = *state;
    rays r = rays_random(100000, 0.6f * w->radius, 4);
    rays_closest(w, &r, NULL, r.count);
    uint32_t placed = 0, mirrored = 0, bad = 0;
    for (uint32_t i = 0; i < r.count; i++) {
        if (r.triangle[i] >= TRIANGLE_REFUSED) continue;
        dvec3 a = corner(w, r.triangle[i], r.instance[i], 0), b = corner(w, r.triangle[i], r.instance[i], 1),
              c = corner(w, r.triangle[i], r.instance[i], 2);
        dvec3 o = to_double(rays_origin(&r, i)), d = to_double(rays_direction(&r, i));
        dvec3 along = d3_add(o, d3_scale(d, (double)r.t[i])), u = d3_scale(d3_sub(b, a), (double)r.u[i]);
        dvec3 off = d3_sub(along, d3_add(a, d3_add(u, d3_scale(d3_sub(c, a), (double)r.v[i]))));
        dvec3 n = d3_cross(d3_sub(b, a), d3_sub(c, a));
        /* Along a needle, and under a glancing ray, a place is known less well. */
        double longest = fmax(d3_length(d3_sub(b, a)), d3_length(d3_sub(c, a)));
        double slant = fabs(d3_dot(d3_normalize(n), d)), shape = d3_length(n) / (longest * longest);
        bad += d3_length(off) > 2e-6 / fmax(slant * fmin(shape, 1), 1e-4);
        placed += r.instance[i] > 0;
        mirrored += w->instances[r.instance[i]].side < 0;
    }
    assert_int_equal(bad, 0);
    assert_true(placed > 1000 && mirrored > 1000 && mirrored < placed);
    rays_free(&r);
}

/* Against every triangle of a small scene, in double; undecided are rays that pass an edge within rounding. */
static void nothing_nearer_is_missed(void **state) {
    (void)state;
    scene_builder b = builder_make();
    stream s = {5, 0};
    add_slivers(&b, &s, 100, 1e-5f);
    add_sphere(&b, 0, (float[]){0.1f, 0.2f, 0.3f}, 0.5f, 12, 0);
    add_instance(&b, add_waves(&b, 0, 10), NULL);
    world *w = build_world(&b);
    rays r = rays_random(10000, 0.6f * w->radius, 6);
    rays_closest(w, &r, NULL, r.count);
    uint32_t decided = 0;
    for (uint32_t i = 0; i < r.count; i++) {
        dvec3 o = to_double(rays_origin(&r, i)), d = to_double(rays_direction(&r, i));
        double nearest = INFINITY, doubt = INFINITY;
        for (uint32_t k = 0; k < w->triangle_count; k++) {
            double margin, t = distance_to(o, d, corner(w, k, 0, 0), corner(w, k, 0, 1), corner(w, k, 0, 2), &margin);
            if (fabs(margin) < doubt) doubt = fabs(margin);
            if (t > 0 && t < nearest) nearest = t;
        }
        if (doubt < 2e-6) continue;
        decided++;
        double t = r.triangle[i] == TRIANGLE_NONE ? INFINITY : (double)r.t[i];
        if (isinf(t) != isinf(nearest) || (isfinite(t) && fabs(t - nearest) > 1e-3))
            fail_msg("ray %u ends at %.9g instead of %.9g", i, t, nearest);
    }
    assert_true(decided > r.count * 9 / 10);
    rays_free(&r);
    world_destroy(w);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(occlusion_agrees_with_the_closest_hit),
        cmocka_unit_test(packing_changes_nothing),
        cmocka_unit_test(hits_lie_on_their_triangles),
        cmocka_unit_test(nothing_nearer_is_missed),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
