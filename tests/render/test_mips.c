/* Pyramids against a box filter in double, the choice of a level against closed forms, and which textures have one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "render/path/cone.h"
#include "render/world/mips.h"
#include "scene/transfer.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

static double value_at(const texture_grid *g, int x, int y, int k) {
    texel c = texture_load(g, x, y);
    return (double)(k == 0 ? c.r : k == 1 ? c.g : k == 2 ? c.b : c.a);
}

/* The mean of texels [x0, x1) × [y0, y1), which need not be whole. */
static double box(const texture_grid *g, double x0, double x1, double y0, double y1, int k) {
    double sum = 0;
    for (int y = (int)floor(y0); y < y1 - 1e-9; y++)
        for (int x = (int)floor(x0); x < x1 - 1e-9; x++)
            sum += value_at(g, x, y, k) * (fmin(x1, x + 1) - fmax(x0, x)) * (fmin(y1, y + 1) - fmax(y0, y));
    return sum / ((x1 - x0) * (y1 - y0));
}

/* Each level is the mean of the one before, in linear light, for every format and for odd sizes; so the last texel is
 * the mean of the picture. Codes of 8 bits end in 16, where half a step is 2⁻¹⁷. */
static void levels_are_means(void **state) {
    (void)state;
    static const int sizes[][2] = {{8, 8}, {5, 3}, {7, 1}, {1, 6}, {13, 4}, {2, 9}, {1, 1}};
    kiln_decoding decoding;
    transfer_rec709(&decoding);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int format = 0; format < 3; format++) {
            int w = sizes[i][0], h = sizes[i][1];
            unsigned char codes[4 * 13 * 13];
            uint16_t words[4 * 13 * 13];
            float floats[4 * 13 * 13];
            for (uint32_t k = 0; k < 4 * 13 * 13; k++) {
                floats[k] = unit_float(hash_pair(71, k));
                codes[k] = (unsigned char)(255 * floats[k]), words[k] = (uint16_t)(65535 * floats[k]);
                floats[k] *= 100; /* radiance need not end at 1 */
            }
            const void *texels[] = {codes, words, floats};
            texture_grid from = {texels[format], w, h, (kiln_pixel_format)format, decoding.curve[KILN_TRANSFER_SRGB]};
            const texture_grid whole = from;
            size_t bytes;
            unsigned char *levels = mips_make(&from, &bytes), *at = levels;
            assert_non_null(levels);
            int32_t count = 0;
            for (; from.width > 1 || from.height > 1; count++) {
                texture_grid to = texture_grid_above(&from, at);
                double sx = (double)from.width / to.width, sy = (double)from.height / to.height;
                for (int y = 0; y < to.height; y++)
                    for (int x = 0; x < to.width; x++)
                        for (int k = 0; k < 4; k++) {
                            double mean = box(&from, x * sx, (x + 1) * sx, y * sy, (y + 1) * sy, k), got = value_at(&to, x, y, k);
                            if (fabs(got - mean) > (format == 2 ? 1e-4 : 0x1.01p-17))
                                fail_msg("%d x %d, format %d, level %d (%d, %d)[%d]: %g instead of %g", w, h, format, count + 1,
                                         x, y, k, got, mean);
                        }
                at += (size_t)to.width * (size_t)to.height * (format == 2 ? 16 : 8);
                from = to;
            }
            assert_int_equal(count, mips_count(w, h));
            assert_int_equal((size_t)(at - levels), bytes);
            for (int k = 0; k < 4; k++)
                assert_true(fabs(value_at(&from, 0, 0, k) - box(&whole, 0, w, 0, h, k)) < (format == 2 ? 1e-3 : 4e-5));
            free(levels);
        }
}

/* A level's texel is seen where the picture's are, in every wrap mode. */
static void levels_lie_where_the_picture_lies(void **state) {
    (void)state;
    float texels[4 * 8 * 8];
    for (int i = 0; i < 4 * 64; i++) texels[i] = (float)(i / 4 % 8);
    for (int wrap = 0; wrap < 3; wrap++) {
        world_texture t = {.texels = texels, .width = 8, .height = 8, .format = KILN_PIXELS_F32, .wrap_u = (kiln_wrap)wrap,
                           .wrap_v = (kiln_wrap)wrap, .transform = {1, 0, 0, 0, 1, 0}, .level_count = 3};
        const texture_grid g = {texels, 8, 8, KILN_PIXELS_F32, NULL};
        size_t bytes;
        void *levels = mips_make(&g, &bytes);
        t.levels = levels;
        for (int k = 0; k < 4; k++) assert_true(texture_sample_level(&t, (float)(2 * k + 1) / 8, 0.3f, 1).r == 2 * (float)k + 0.5f);
        assert_true(texture_sample_level(&t, 0.25f, 0.3f, 2).r == 1.5f && texture_sample_level(&t, 0.9f, 7, 3).r == 3.5f);
        float edge = texture_sample_level(&t, 0, 0.3f, 1).r; /* between the last and the first, or the first alone */
        assert_true(edge == (wrap == KILN_WRAP_REPEAT ? 3.5f : 0.5f));
        free(levels);
    }
}

/* Level k where the footprint's smaller axis is 2ᵏ⁺¹ texels or more: whatever the shape of picture, transform and UV. */
static void the_smaller_axis_chooses(void **state) {
    (void)state;
    world_texture t = {.width = 1024, .height = 256, .transform = {1, 0, 0, 0, 1, 0}, .level_count = 10, .levels = &t};
    const vec3 e1 = {2, 0, 0}, e2 = {0, 0, 0.5f};
    for (int k = 0; k < 9; k++)
        for (int side = -1; side <= 1; side += 2) {
            /* 1024 texels over 2, 256 over 0.5: 512 a unit both ways */
            float width = (float)ldexp(1 + side * 1e-3, k + 1) / 512;
            int32_t expected = k + (side < 0 ? -1 : 0);
            texture_footprint f = cone_footprint(width, e1, e2, (vec2){1, 0}, (vec2){0, 1});
            assert_int_equal(texture_level(&t, f), expected < 0 ? 0 : expected);
        }
    /* Four times as many texels one way change nothing, fewer do; a turned triangle sees the same. */
    const float width = 16.5f / 512;
    texture_footprint f = cone_footprint(width, e1, e2, (vec2){4, 0}, (vec2){0, 1});
    assert_int_equal(texture_level(&t, f), 3);
    assert_int_equal(texture_level(&t, cone_footprint(width, e1, e2, (vec2){1, 0}, (vec2){0, 0.25f})), 1);
    assert_int_equal(texture_level(&t, cone_footprint(width, e2, v3_add(e1, e2), (vec2){0, 1}, (vec2){1, 1})), 3);
    const float turned[6] = {0, 0.25f, 0, 4, 0, 0}; /* u' = v/4, v' = 4 u: still 512 a unit, but 128 × 2 and 2 × 512 */
    for (int i = 0; i < 6; i++) t.transform[i] = turned[i];
    assert_int_equal(texture_level(&t, cone_footprint(width, e1, e2, (vec2){1, 0}, (vec2){0, 1})), 3);
    assert_int_equal(texture_level(&t, (texture_footprint){NAN, NAN, NAN}), 0);
    assert_int_equal(texture_level(&t, (texture_footprint){INFINITY, 0, INFINITY}), 0);
    assert_int_equal(texture_level(&t, (texture_footprint){1e9f, 0, 1e9f}), 10);
    t.levels = NULL;
    assert_int_equal(texture_level(&t, (texture_footprint){1e9f, 0, 1e9f}), 0);
}

/* A unit sphere has curvature 1 from outside and −1 from inside, a cylinder's lower one is 0. */
static void curvature_is_that_of_the_surface(void **state) {
    (void)state;
    const float a = 0.05f;
    const vec3 p0 = {0, 0, 1}, p1 = {sinf(a), 0, cosf(a)}, p2 = {0, sinf(a), cosf(a)};
    vec3 e1 = v3_sub(p1, p0), e2 = v3_sub(p2, p0);
    cone_curvature k = cone_curvature_of(e1, e2, v3_scale(p0, 3), p1, p2, p0);
    assert_true(fabsf(k.low - 1) < 1e-3f && fabsf(k.high - 1) < 1e-3f);
    k = cone_curvature_of(e1, e2, p0, p1, p2, v3_neg(p0));
    assert_true(fabsf(k.low + 1) < 1e-3f && fabsf(k.high + 1) < 1e-3f);
    k = cone_curvature_of(e1, (vec3){0, 2, 0}, p0, p1, p0, p0);
    assert_true(fabsf(k.low) < 1e-3f && fabsf(k.high - 1) < 1e-2f);
    k = cone_curvature_of(e1, e2, p0, p0, p0, p0);
    assert_true(k.low == 0 && k.high == 0);
    k = cone_curvature_of(e1, e2, p0, p1, (vec3){0, 0, 0}, p0);
    assert_true(k.low == 0 && k.high == 0);
}

static void bounces_change_cones(void **state) {
    (void)state;
    const cone at = {0.1f, 0.01f};
    cone_bounce b = {.d = {0, 0, -1}, .n = {0, 0, 1}, .wi = {0, 0, 1}, .eta = 1};
    cone c = cone_scatter(at, &b);
    assert_true(c.width == at.width && c.spread == at.spread); /* a flat mirror */
    b.curvature = (cone_curvature){2, 5};
    assert_float_equal(cone_scatter(at, &b).spread, 0.01f + 2 * 2 * 0.1f, 1e-6f); /* the image of a ball, f = 1/(2 k) */
    b.curvature = (cone_curvature){-2, 5};
    c = cone_scatter(at, &b);
    assert_true(c.width == 0 && c.spread == 0);
    b.curvature = (cone_curvature){0, 0};
    b.bumpy = 1;
    c = cone_scatter(at, &b);
    assert_true(c.width == 0 && c.spread == 0);
    b.bumpy = 0, b.eta = 1.5f, b.bends = 1, b.wi = v3(0, 0, -1);
    assert_float_equal(cone_scatter(at, &b).spread, 0.01f / 1.5f, 1e-7f);
    b.curvature = (cone_curvature){1, 1}; /* a lens collects, from inside it spreads: (n − 1) k w / n, (1 − 1/n) n k w */
    assert_true(cone_scatter(at, &b).width == 0);
    b.eta = 1 / 1.5f;
    assert_float_equal(cone_scatter(at, &b).spread, 0.01f * 1.5f + 0.5f * 0.1f, 1e-6f);
    b.bends = 0, b.passes = 1;
    c = cone_scatter(at, &b);
    assert_true(c.width == at.width && c.spread == at.spread);
    /* Lobes: never more than a share of what sets their directions apart. */
    b = (cone_bounce){.d = {0, 0, -1}, .n = {0, 0, 1}, .wi = {0.6f, 0, 0.8f}, .eta = 1, .pdf = 0.8f / 3.14159265f};
    assert_float_equal(cone_scatter(at, &b).spread, 0.01f + CONE_SHARE * sqrtf(0.36f + 0.04f), 1e-6f);
    b.pdf = 1e4f;
    assert_float_equal(cone_scatter(at, &b).spread, 0.01f + CONE_SHARE * 0.01f, 1e-6f);
}

/* Of one picture in every role: coverage, emission, normals, directions and nearest texels are never averaged. */
static void some_textures_are_left_alone(void **state) {
    (void)state;
    const struct { kiln_alpha_mode alpha; kiln_filter filter; kiln_texture_filter wanted; int role; bool has; } rows[] = {
        {KILN_ALPHA_OPAQUE, KILN_FILTER_LINEAR, KILN_TEXTURES_MIP, 0, true},
        {KILN_ALPHA_OPAQUE, KILN_FILTER_LINEAR, KILN_TEXTURES_BILINEAR, 0, false},
        {KILN_ALPHA_OPAQUE, KILN_FILTER_NEAREST, KILN_TEXTURES_MIP, 0, false},
        {KILN_ALPHA_MASK, KILN_FILTER_LINEAR, KILN_TEXTURES_MIP, 0, false},
        {KILN_ALPHA_BLEND, KILN_FILTER_LINEAR, KILN_TEXTURES_MIP, 0, false},
        {KILN_ALPHA_OPAQUE, KILN_FILTER_LINEAR, KILN_TEXTURES_MIP, 1, false},
        {KILN_ALPHA_OPAQUE, KILN_FILTER_LINEAR, KILN_TEXTURES_MIP, 2, false},
        {KILN_ALPHA_OPAQUE, KILN_FILTER_LINEAR, KILN_TEXTURES_MIP, 3, false},
        {KILN_ALPHA_OPAQUE, KILN_FILTER_LINEAR, KILN_TEXTURES_MIP, 4, false}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        scene_builder b = builder_make();
        const float rgb[12] = {0.1f, 0.2f, 0.3f, 0.4f};
        kiln_material m = diffuse_material(1, 1, 1);
        kiln_texture *const roles[] = {&m.base_color.texture, &m.emission.texture, &m.normal.texture,
                                       &m.clearcoat_normal.texture, &m.anisotropy.texture}, *t = roles[rows[i].role];
        m.layers = KILN_LAYER_CLEARCOAT | KILN_LAYER_ANISOTROPY;
        m.clearcoat.value = m.anisotropy.value = m.emission.value[0] = 1;
        m.alpha_mode = rows[i].alpha;
        m.opacity.value = 0.4f; /* or coverage would be none */
        *t = (kiln_texture){.image = add_image(&b, rgb, 2, 2), .filter = rows[i].filter,
                            .transfer = rows[i].role >= 2 ? KILN_TRANSFER_DATA : KILN_TRANSFER_LINEAR};
        add_quad(&b, add_material(&b, &m), (float[]){0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
        kiln_decoding decoding;
        transfer_rec709(&decoding);
        world *w;
        must(world_create(b.scene, &(world_build_options){&decoding, rows[i].wanted, .threads = 1}, &w, b.report), b.report, "building the world");
        assert_int_equal(w->texture_count, 1);
        if ((w->textures[0].levels != NULL) != rows[i].has || RUNS(w, TEXTURE_FILTERING) != rows[i].has) fail_msg("row %zu", i);
        world_destroy(w);
        builder_free(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_means),
        cmocka_unit_test(levels_lie_where_the_picture_lies),
        cmocka_unit_test(the_smaller_axis_chooses),
        cmocka_unit_test(curvature_is_that_of_the_surface),
        cmocka_unit_test(bounces_change_cones),
        cmocka_unit_test(some_textures_are_left_alone),
    };
    return cmocka_run_group_tests_name("mips", tests, NULL, NULL);
}
