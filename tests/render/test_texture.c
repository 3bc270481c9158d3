/* Look-ups in textures against a table of texels in double: wrap modes, filters, formats, curves and transforms, and
 * how pictures of a scene become textures. Seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/world/world.h"
#include "scene/transfer.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

enum { W = 5, H = 3 };
static float texels[4 * W * H];

static world_texture plain(kiln_wrap u, kiln_wrap v, bool nearest) {
    for (uint32_t i = 0; i < 4 * W * H; i++) texels[i] = unit_float(hash_pair(51, i));
    return (world_texture){.texels = texels, .width = W, .height = H, .format = KILN_PIXELS_F32, .wrap_u = u,
                           .wrap_v = v, .nearest = nearest, .transform = {1, 0, 0, 0, 1, 0}};
}

/* Which texel of n stands at an integer place anywhere on the line. */
static int wrapped(kiln_wrap mode, double place, int n) {
    if (mode == KILN_WRAP_CLAMP) return (int)fmin(fmax(place, 0), n - 1);
    double turn = fmod(place, mode == KILN_WRAP_MIRROR ? 2 * n : n);
    if (turn < 0) turn += mode == KILN_WRAP_MIRROR ? 2 * n : n;
    return turn < n ? (int)turn : 2 * n - 1 - (int)turn;
}
static double texel_at(const world_texture *t, double x, double y, int channel) {
    return (double)texels[4 * (wrapped(t->wrap_v, y, H) * W + wrapped(t->wrap_u, x, W)) + channel];
}
/* What a look-up should give: texel (i, j) is at ((i + 1/2)/W, (j + 1/2)/H), v down. */
static double look_up(const world_texture *t, double u, double v, int channel) {
    double x = u * W, y = v * H;
    if (t->nearest) return texel_at(t, floor(x), floor(y), channel);
    double i = floor(x - 0.5), j = floor(y - 0.5), fx = x - 0.5 - i, fy = y - 0.5 - j;
    double top = (1 - fx) * texel_at(t, i, j, channel) + fx * texel_at(t, i + 1, j, channel);
    double low = (1 - fx) * texel_at(t, i, j + 1, channel) + fx * texel_at(t, i + 1, j + 1, channel);
    return (1 - fy) * top + fy * low;
}

static double nearest_edge(double x) { return fabs(x - nearbyint(x)); }

static void compare(const world_texture *t, float u, float v, double tolerance) {
    texel c = texture_sample(t, u, v);
    const float got[4] = {c.r, c.g, c.b, c.a};
    for (int k = 0; k < 4; k++) {
        double expected = look_up(t, (double)u, (double)v, k);
        if (fabs((double)got[k] - expected) > tolerance)
            fail_msg("wrap %d %d, nearest %d, (%.9g, %.9g)[%d]: %g instead of %g", t->wrap_u, t->wrap_v, t->nearest,
                     (double)u, (double)v, k, (double)got[k], expected);
    }
}

/* Anywhere, also far off and on the negative side, where a coordinate has lost digits: those that are left count. */
static void coordinates_wrap(void **state) {
    (void)state;
    for (int mode = 0; mode < 18; mode++) {
        world_texture t = plain((kiln_wrap)(mode % 3), (kiln_wrap)(mode / 3 % 3), mode >= 9);
        stream s = {52, 0};
        for (int i = 0; i < 3000; i++) {
            float reach = i % 3 == 0 ? 1.5f : i % 3 == 1 ? 40 : 30000;
            float u = stream_between(&s, -reach, reach), v = stream_between(&s, -reach, reach);
            /* Of nearest texels, those whose choice no rounding decides. */
            if (t.nearest && (nearest_edge((double)u * W) < 1e-5 || nearest_edge((double)v * H) < 1e-5)) continue;
            compare(&t, u, v, 5e-6);
        }
    }
}

/* At a texel's centre both filters give the texel; at an edge the linear one the mean, nearest the one behind it;
 * across the picture's own edge the neighbour is what the wrap mode says. */
static void centres_and_edges(void **state) {
    (void)state;
    for (int mode = 0; mode < 3; mode++)
        for (int nearest = 0; nearest < 2; nearest++) {
            world_texture t = plain((kiln_wrap)mode, (kiln_wrap)mode, nearest);
            t.width = 4, t.height = 2; /* powers of two: coordinates are exact */
            for (int i = -4; i < 8; i++) {
                int x0 = wrapped((kiln_wrap)mode, i, 4), x1 = wrapped((kiln_wrap)mode, i + 1, 4);
                texel c = texture_sample(&t, ((float)i + 0.5f) / 4, 0.25f);
                assert_true(c.r == texels[4 * x0] && c.a == texels[4 * x0 + 3]);
                float edge = texture_sample(&t, ((float)i + 1) / 4, 0.25f).r;
                bool turned = mode == KILN_WRAP_MIRROR && (i < -1 || i >= 3); /* so its edges are the other texel's */
                if (nearest && turned) x1 = x0;
                assert_float_equal(edge, nearest ? texels[4 * x1] : 0.5f * (texels[4 * x0] + texels[4 * x1]), 1e-6f);
            }
            assert_true(texture_sample(&t, 0.125f, 0.75f).g == texels[4 * 4 + 1]); /* v runs down */
        }
}

/* Coordinates without digits, and none at all: some texel, and nothing read outside. */
static void strange_coordinates_are_harmless(void **state) {
    (void)state;
    static const float strange[] = {NAN, INFINITY, -INFINITY, 3.4e38f, -3.4e38f, 0x1p24f, -0x1p24f, 0x1.fffffep23f,
                                    -0x1.fffffep23f, -1e-9f, -0x1p-149f, 0x1.fffffep-1f, 1, -1, 0x1.000002p0f};
    enum { STRANGE = sizeof strange / sizeof *strange };
    for (int mode = 0; mode < 6; mode++) {
        world_texture t = plain((kiln_wrap)(mode % 3), (kiln_wrap)(mode % 3), mode >= 3);
        for (int i = 0; i < STRANGE; i++)
            for (int j = 0; j < STRANGE; j++) {
                texel c = texture_sample(&t, strange[i], strange[j]);
                assert_true(c.r >= 0 && c.r <= 1 && c.a >= 0 && c.a <= 1);
            }
        t.width = t.height = 1;
        for (int i = 0; i < STRANGE; i++)
            assert_true(texture_sample(&t, strange[i], strange[STRANGE - 1 - i]).r == texels[0]);
        t.transform[0] = INFINITY;
        assert_true(texture_sample(&t, 0, 0).r == texels[0]);
    }
}

/* u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5, before the wrap. */
static void transforms_move_coordinates(void **state) {
    (void)state;
    world_texture t = plain(KILN_WRAP_REPEAT, KILN_WRAP_MIRROR, false), moved = t;
    const float m[6] = {0.5f, -1.25f, 0.75f, 2, 0.25f, -3};
    for (int i = 0; i < 6; i++) moved.transform[i] = m[i];
    stream s = {53, 0};
    for (int i = 0; i < 2000; i++) {
        float u = stream_between(&s, -2, 2), v = stream_between(&s, -2, 2);
        texel a = texture_sample(&moved, u, v);
        texel b = texture_sample(&t, m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]);
        assert_true(a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a);
    }
}

/* Codes of 8 bits go through the curve, alpha does not; 16 bits are fractions of 65535; a channel is one of four. */
static void formats_decode(void **state) {
    (void)state;
    kiln_decoding d;
    transfer_rec709(&d);
    uint8_t codes[256 * 4];
    uint16_t words[256 * 4];
    for (int i = 0; i < 256; i++)
        for (int k = 0; k < 4; k++) {
            codes[4 * i + k] = (uint8_t)(k == 3 ? 255 - i : i + 7 * k);
            words[4 * i + k] = (uint16_t)(257 * i + k * 1000);
        }
    world_texture t = {.texels = codes, .width = 256, .height = 1, .format = KILN_PIXELS_U8, .nearest = true,
                       .transform = {1, 0, 0, 0, 1, 0}, .curve = d.curve[KILN_TRANSFER_SRGB]}, w = t;
    w.format = KILN_PIXELS_U16, w.texels = words;
    for (int i = 0; i < 256; i++) {
        float u = ((float)i + 0.5f) / 256;
        texel c = texture_sample(&t, u, 0.5f), wide = texture_sample(&w, u, 0.5f);
        double green = codes[4 * i + 1] / 255.0; /* IEC 61966-2-1 */
        green = green <= 0.04045 ? green / 12.92 : pow((green + 0.055) / 1.055, 2.4);
        assert_true(fabs((double)c.g - green) < 1e-6 && fabs((double)c.a - (255 - i) / 255.0) < 1e-7);
        assert_true(fabs((double)wide.b - words[4 * i + 2] / 65535.0) < 1e-7);
        for (uint32_t k = 0; k < 4; k++) {
            t.channel = k;
            assert_true(texture_channel(&t, u, 0.5f) == (k == 0 ? c.r : k == 1 ? c.g : k == 2 ? c.b : c.a));
        }
    }
    t.has_matrix = true;
    const float m[9] = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f};
    for (int i = 0; i < 9; i++) t.matrix[i] = m[i];
    texel c = texture_sample(&t, 0.3f, 0.5f);
    t.has_matrix = false;
    texel raw = texture_sample(&t, 0.3f, 0.5f);
    assert_float_equal(c.g, 0.4f * raw.r + 0.5f * raw.g + 0.6f * raw.b, 1e-6f);
    assert_true(c.a == raw.a);
}

/* A picture's first texel as a material's base colour shows it, for each format, number of channels and transfer. */
static void pictures_become_textures(void **state) {
    (void)state;
    const uint8_t bytes[8] = {51, 102, 153, 204};
    const uint16_t words[8] = {13107, 26214, 39321, 52428}; /* the same fractions */
    const float floats[8] = {0.2f, 0.4f, 0.6f, 0.8f};
    const void *pixels[3] = {bytes, words, floats};
    for (int format = 0; format < 3; format++)
        for (uint32_t channels = 1; channels <= 4; channels++)
            for (int transfer = 0; transfer < KILN_TRANSFER_COUNT; transfer++) {
                scene_builder b = builder_make();
                kiln_material m = diffuse_material(1, 1, 1);
                kiln_image_desc image = {.name = "texel", .pixels = pixels[format], .width = 2, .height = 1,
                                         .channels = channels, .format = (kiln_pixel_format)format};
                must(kiln_scene_add_image(b.scene, &image, &m.base_color.texture.image, b.report), b.report,
                     "an image");
                m.base_color.texture.transfer = (kiln_transfer)transfer;
                add_quad(&b, add_material(&b, &m), (float[]){0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
                world *w = build_world(&b);
                assert_int_equal(w->texture_count, 1);
                texel c = texture_sample(&w->textures[0], 0.25f, 0.1f);
                const float got[4] = {c.r, c.g, c.b, c.a};
                for (uint32_t k = 0; k < 4; k++) {
                    bool grey = channels < 3;
                    double code = k == 3 ? channels == 2 ? 0.4 : channels == 4 ? 0.8 : 1 : 0.2 * (grey ? 1 : k + 1);
                    if (k < 3 && transfer == KILN_TRANSFER_SRGB) code = pow((code + 0.055) / 1.055, 2.4);
                    if (fabs((double)got[k] - code) > 1e-6)
                        fail_msg("format %d, %u channels, transfer %d: [%u] is %g instead of %g", format, channels,
                                 transfer, k, (double)got[k], code);
                }
                world_destroy(w);
                builder_free(&b);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coordinates_wrap),            cmocka_unit_test(centres_and_edges),
        cmocka_unit_test(strange_coordinates_are_harmless), cmocka_unit_test(transforms_move_coordinates),
        cmocka_unit_test(formats_decode),              cmocka_unit_test(pictures_become_textures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
