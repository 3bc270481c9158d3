/* Partial coverage: what OPAQUE, MASK and BLEND let through, along rays of the camera and of light. Monte Carlo
 * estimates are joint at the level of one false alarm in a thousand for each test; seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/accel/accel.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

#define LEVEL 1e-3

enum { LAYERS_MAX = 8 };

/* Black sheets of so much alpha, one above the other over the x–z plane. */
typedef struct stack {
    const char *name;
    kiln_alpha_mode mode;
    int count;
    float alpha[LAYERS_MAX], cutoff;
    double passes; /* the share of light that should come through */
} stack;

static const stack stacks[] = {
    {"opaque", KILN_ALPHA_OPAQUE, 1, {0.3f}, 0, 0},
    {"nothing", KILN_ALPHA_BLEND, 1, {0}, 0, 1},
    {"everything", KILN_ALPHA_BLEND, 1, {1}, 0, 0},
    {"a third", KILN_ALPHA_BLEND, 1, {0.3f}, 0, 0.7},
    {"most", KILN_ALPHA_BLEND, 1, {0.96f}, 0, 0.04},
    {"two halves", KILN_ALPHA_BLEND, 2, {0.5f, 0.5f}, 0, 0.25},
    {"two unequal", KILN_ALPHA_BLEND, 2, {0.2f, 0.7f}, 0, 0.24},
    {"four", KILN_ALPHA_BLEND, 4, {0.2f, 0.3f, 0.4f, 0.5f}, 0, 0.168},
    {"eight", KILN_ALPHA_BLEND, 8, {.1f, .1f, .1f, .1f, .1f, .1f, .1f, .1f}, 0, 0.43046721},
    {"mask above", KILN_ALPHA_MASK, 1, {0.51f}, 0.5f, 0},
    {"mask at", KILN_ALPHA_MASK, 1, {0.5f}, 0.5f, 0},
    {"mask below", KILN_ALPHA_MASK, 1, {0x1.fffffep-2f}, 0.5f, 1},
    {"mask at 0", KILN_ALPHA_MASK, 1, {0}, 0, 0},
    {"mask beyond 1", KILN_ALPHA_MASK, 1, {1}, 1.5f, 1},
    {"masks", KILN_ALPHA_MASK, 3, {0.1f, 0.2f, 0.3f}, 0.4f, 1},
};
enum { STACKS = sizeof stacks / sizeof *stacks };

static void add_stack(scene_builder *b, const stack *s, float lowest) {
    for (int i = 0; i < s->count; i++) {
        kiln_material m = diffuse_material(0, 0, 0);
        m.alpha_mode = s->mode;
        m.opacity.value = s->alpha[i];
        m.alpha_cutoff = s->cutoff;
        m.double_sided = true;
        float y = lowest + 0.05f * (float)i;
        add_quad(b, add_material(b, &m), (float[]){-3, y, 3, 3, y, 3, 3, y, -3, -3, y, -3});
    }
}

/* Pixels are independent of each other, samples of one pixel are not: the error is that between pixels. */
static void expect_share(const picture *p, const stack *s, double share, double tests) {
    tally pixels = {0};
    for (uint32_t i = 0; i < p->width * p->height; i++) tally_add(&pixels, (double)p->rgb[3 * i]);
    double off = pixels.mean - share, error = tally_error(&pixels);
    if (fabs(off) > 1e-6 && !(error > 0 && normal_tail(off / error) > sidak(LEVEL, tests)))
        fail_msg("%s: %.6f ± %.6f instead of %.6f", s->name, pixels.mean, error, share);
}

/* Seen through the sheets, a floor that shines has Π (1 − alpha) of its radiance. */
static void camera_rays_pass_in_proportion(void **state) {
    (void)state;
    for (int i = 0; i < STACKS; i++)
        for (int sampler = 0; sampler < 2; sampler++) {
            scene_builder b = builder_make();
            kiln_material lamp = diffuse_material(1, 1, 1);
            lamp.layers = KILN_LAYER_UNLIT;
            add_quad(&b, add_material(&b, &lamp), (float[]){-3, 0, 3, 3, 0, 3, 3, 0, -3, -3, 0, -3});
            add_stack(&b, &stacks[i], 1);
            kiln_camera view = camera_at((float[]){0.1f, 4, 0.2f}, (float[]){0, 0, 0}, 10);
            kiln_render_options o = {.spp = 16, .max_depth = 1, .sampler = (kiln_sampler)sampler};
            picture p = render(&b, &view, &o, 32, 32);
            expect_share(&p, &stacks[i], stacks[i].passes, 2 * STACKS);
            picture_free(&p);
            builder_free(&b);
        }
}

/* The same along shadow rays: a point light above the sheets, whose irradiance the floor shows, looked at from below
 * them. */
static void shadow_rays_pass_in_proportion(void **state) {
    (void)state;
    for (int i = 0; i < STACKS; i++) {
        scene_builder b = builder_make();
        kiln_material floor = diffuse_material(1, 1, 1);
        add_quad(&b, add_material(&b, &floor), (float[]){-3, 0, 3, 3, 0, 3, 3, 0, -3, -3, 0, -3});
        add_stack(&b, &stacks[i], 1);
        kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[]){0, 1, 0}, (float[]){0, 0, 0}, (float)M_PI);
        add_light(&b, &sun);
        kiln_camera view = camera_at((float[]){0.1f, 0.9f, 0.2f}, (float[]){0, 0, 0}, 10);
        picture p = render(&b, &view, &(kiln_render_options){.spp = 16, .max_depth = 1}, 32, 32);
        expect_share(&p, &stacks[i], stacks[i].passes, STACKS);
        picture_free(&p);
        builder_free(&b);
    }
}

/* A ray's share over many samples, at a place of a world. */
static double share_stopped(const world *w, float x, uint32_t seed, int independent) {
    enum { RAYS = 4096 };
    static float ox[RAYS], oy[RAYS], oz[RAYS], dx[RAYS], dy[RAYS], dz[RAYS];
    static uint32_t seeds[RAYS], indices[RAYS], visible[RAYS];
    for (uint32_t i = 0; i < RAYS; i++) {
        ox[i] = x, oy[i] = 1, oz[i] = 0.1f;
        dx[i] = 0, dy[i] = -1, dz[i] = 0;
        seeds[i] = seed, indices[i] = i;
    }
    trace_counts counts = {0};
    ray_lanes rays = {ox, oy, oz, dx, dy, dz, NULL, NULL, {seeds, indices, 7, independent}, NULL, RAYS, false};
    accel_visible(w, &rays, visible, &counts);
    double stopped = 0;
    for (int i = 0; i < RAYS; i++) stopped += visible[i] == RAY_STOPPED;
    return stopped / RAYS;
}

/* Alpha is factor times texture times vertex colour, interpolated (glTF 2.0, 3.9.2 and 3.7.2.1): here 0.8 · (85/255)
 * times a ramp from 0 at x = −1 to 1 at x = 1. Sobol' samples of one ray hit that share to within a few of 4096;
 * independent ones to within their binomial error. */
static void alpha_is_a_product(void **state) {
    (void)state;
    scene_builder b = builder_make();
    const uint8_t rgba[4] = {255, 0, 13, 85};
    kiln_material m = diffuse_material(1, 1, 1);
    m.alpha_mode = KILN_ALPHA_BLEND;
    m.opacity.value = 0.8f;
    m.opacity.texture.channel = 3;
    kiln_image_desc image = {.name = "alpha", .pixels = rgba, .width = 1, .height = 1, .channels = 4};
    must(kiln_scene_add_image(b.scene, &image, &m.opacity.texture.image, b.report), b.report, "adding an image");
    const float p[12] = {-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1}, uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    const float colors[16] = {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    const kiln_primvar primvars[] = {{.kind = KILN_PRIMVAR_UV, .values = uv, .value_count = 4},
                                     {.kind = KILN_PRIMVAR_COLOR, .values = colors, .value_count = 4}};
    kiln_mesh_desc sheet = {.name = "sheet", .vertex_count = 4, .positions = p, .face_count = 2, .face_vertices = faces,
                            .primvars = primvars, .primvar_count = 2, .material = add_material(&b, &m)};
    add_instance(&b, add_mesh(&b, &sheet), NULL);
    world *w = build_world(&b);
    enum { PLACES = 17 };
    for (uint32_t i = 0; i < PLACES; i++) {
        double x = -0.96 + 0.12 * i, alpha = 0.8 / 3 * (0.5 + 0.5 * x);
        float at = (float)(x * w->scale); /* the sheet's centre is the origin */
        double sobol = share_stopped(w, at, i, 0), independent = share_stopped(w, at, i, 1);
        double z = (independent - alpha) / sqrt(alpha * (1 - alpha) / 4096);
        if (fabs(sobol - alpha) > 3.0 / 4096 || normal_tail(z) < sidak(LEVEL, PLACES))
            fail_msg("at x = %g %.6f and %.6f are stopped instead of %.6f", x, sobol, independent, alpha);
    }
    world_destroy(w);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_rays_pass_in_proportion),
        cmocka_unit_test(shadow_rays_pass_in_proportion),
        cmocka_unit_test(alpha_is_a_product),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
