/* What stands at a point of a triangle without a hit: texture coordinates, alpha, and what scales its emission. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/sample/warp.h"
#include "render/world/lookup.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

static const float alphas[4 * 3] = {0, 0, 0, 0.5f, 0.5f, 0.5f, 0.25f, 0.25f, 0.25f, 1, 1, 1};
static const float glows[4 * 3] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

/* A unit square whose point (x, y) has the texture coordinates (x, 1 − y). */
static world *make_square(scene_builder *b, kiln_alpha_mode mode, bool textured, float coat) {
    kiln_material m = diffuse_material(0.5f, 0.5f, 0.5f);
    m.alpha_mode = mode, m.alpha_cutoff = 0.3f, m.opacity.value = 0.8f;
    for (int k = 0; k < 3; k++) m.emission.value[k] = 1;
    if (coat > 0) m.layers = KILN_LAYER_CLEARCOAT, m.clearcoat.value = coat;
    if (textured) {
        m.opacity.texture = (kiln_texture){.image = add_image(b, alphas, 2, 2), .transfer = KILN_TRANSFER_DATA};
        m.emission.texture = (kiln_texture){.image = add_image(b, glows, 2, 2), .transfer = KILN_TRANSFER_LINEAR};
    }
    add_quad(b, add_material(b, &m), (const float[]){0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    return build_world(b);
}

static dvec3 scene_point(const world *w, uint32_t triangle, vec2 at) {
    const uint32_t *v = w->triangles + 3 * (size_t)triangle;
    vec3 a = v3_load(w->vertices[v[0]].p), b = v3_load(w->vertices[v[1]].p), c = v3_load(w->vertices[v[2]].p);
    vec3 p = v3_madd(v3_madd(v3_scale(a, 1 - at.x - at.y), at.x, b), at.y, c);
    dvec3 d = {(double)p.x, (double)p.y, (double)p.z};
    return d3_add(d3_scale(d, 1 / w->scale), w->center);
}

/* Bilinear between the centres of 2 × 2 texels, repeated: the texels' values by position, closed form. */
static double bilinear(const float *texels, int channel, double u, double v) {
    double x = u * 2 - 0.5, y = v * 2 - 0.5, fx = x - floor(x), fy = y - floor(y), sum = 0;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            int tx = ((int)floor(x) + i + 2) % 2, ty = ((int)floor(y) + j + 2) % 2;
            sum += (i ? fx : 1 - fx) * (j ? fy : 1 - fy) * (double)texels[3 * (2 * ty + tx) + channel];
        }
    return sum;
}

static void check(const world *w, kiln_alpha_mode mode, bool textured, uint32_t triangle, vec2 at) {
    dvec3 p = scene_point(w, triangle, at);
    vec2 uv = lookup_uv(w, triangle, 0, at); /* carried only where a texture reads them */
    if (textured) assert_true(fabs((double)uv.x - p.x) < 1e-5 && fabs((double)uv.y - (1 - p.y)) < 1e-5);
    double alpha = 0.8 * (textured ? bilinear(alphas, 0, p.x, 1 - p.y) : 1);
    if (fabs(alpha - 0.3) < 1e-4) return; /* on the cutoff rounding decides */
    if (mode != KILN_ALPHA_OPAQUE) assert_true(fabs((double)lookup_alpha(w, triangle, at) - alpha) < 1e-5);
    double stands = mode == KILN_ALPHA_BLEND ? alpha : mode == KILN_ALPHA_MASK ? alpha >= 0.3 : 1;
    vec3 e = lookup_emission(w, triangle, at, 1);
    const float got[3] = {e.x, e.y, e.z};
    for (int k = 0; k < 3; k++) {
        double expected = stands * (textured ? bilinear(glows, k, p.x, 1 - p.y) : 1);
        if (fabs((double)got[k] - expected) > 1e-4) fail_msg("channel %d: %g instead of %g", k, (double)got[k], expected);
    }
}

static void points_are_looked_up(void **state) {
    (void)state;
    static const kiln_alpha_mode modes[] = {KILN_ALPHA_OPAQUE, KILN_ALPHA_MASK, KILN_ALPHA_BLEND};
    stream random = {31, 0};
    for (int row = 0; row < 6; row++) {
        scene_builder b = builder_make();
        bool textured = row & 1;
        kiln_alpha_mode mode = modes[row / 2];
        world *w = make_square(&b, mode, textured, 0);
        assert_int_equal(w->triangle_count, 2);
        if (mode == KILN_ALPHA_MASK && !textured) mode = KILN_ALPHA_OPAQUE; /* above its cutoff everywhere */
        for (uint32_t t = 0; t < 2; t++) {
            assert_true(lookup_emission_varies(w, t) == (textured || mode != KILN_ALPHA_OPAQUE));
            for (int i = 0; i < 200; i++) check(w, mode, textured, t, warp_triangle(stream_pair(&random)));
        }
        world_destroy(w);
        builder_free(&b);
    }
}

/* KHR_materials_clearcoat, 'Layering': 1 − clearcoat · (0.04 + 0.96 (1 − cos)^5), from either side of a wall. */
static void coats_dim_emission(void **state) {
    (void)state;
    scene_builder b = builder_make();
    world *w = make_square(&b, KILN_ALPHA_OPAQUE, false, 0.7f);
    assert_true(lookup_emission_varies(w, 0));
    for (int i = -20; i <= 20; i++) {
        double cosine = i / 20.0, expected = 1 - 0.7 * (0.04 + 0.96 * pow(1 - fabs(cosine), 5));
        vec3 e = lookup_emission(w, 0, (vec2){0.3f, 0.3f}, (float)cosine);
        if (i) assert_true(fabs((double)e.x - expected) < 1e-6 && e.x == e.y && e.y == e.z);
    }
    world_destroy(w);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(points_are_looked_up), cmocka_unit_test(coats_dim_emission)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
