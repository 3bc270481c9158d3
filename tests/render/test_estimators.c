/* The three estimators have one expectation. Nine scenes, of which six hold a chain of perfectly specular bounces, a
 * textured emitter, emitters with holes, a coated one, a small bright sun and many lights. Each picture is compared by its
 * mean and by 16 blocks; with 9 scenes, 2 pairs and 17 values, a significance of 1 % in all is 3.3 10⁻⁵ for each (Šidák):
 * 4.16 standard errors.
 *
 * The same source, linked with stages that count emission wrongly, must fail (tests/render/mutants). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

enum { SIDE = 32, BLOCKS = 4, VALUES = BLOCKS * BLOCKS + 1 };
static const double deviations = 4.16;

typedef struct means { double value[VALUES], error[VALUES]; } means;

static means measure(const kiln_film *f) {
    means m = {0};
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            double mean[3], variance[3];
            film_read_pixel(f, (size_t)y * SIDE + x, mean, variance);
            double value = (mean[0] + mean[1] + mean[2]) / 3;
            double deviation = (sqrt(variance[0]) + sqrt(variance[1]) + sqrt(variance[2])) / 3;
            uint32_t block = y * BLOCKS / SIDE * BLOCKS + x * BLOCKS / SIDE;
            m.value[block] += value, m.error[block] += deviation * deviation;
            m.value[VALUES - 1] += value, m.error[VALUES - 1] += deviation * deviation;
        }
    for (int i = 0; i < VALUES; i++) {
        double pixels = i == VALUES - 1 ? SIDE * SIDE : SIDE * SIDE / (BLOCKS * BLOCKS);
        m.value[i] /= pixels;
        m.error[i] = sqrt(m.error[i]) / pixels;
    }
    return m;
}

typedef void builder(scene_builder *);

static void compare(builder *build, const kiln_camera *view, const uint32_t spp[3]) {
    means m[3];
    for (int e = 0; e < 3; e++) {
        scene_builder b = builder_make();
        build(&b);
        kiln_render_options o = {.spp = spp[e], .estimator = (kiln_estimator)e, .seed = 10 + (uint64_t)e, .max_depth = 6};
        picture p = render(&b, view, &o, SIDE, SIDE);
        m[e] = measure(p.film);
        picture_free(&p);
        builder_free(&b);
    }
    for (int e = 1; e < 3; e++)
        for (int i = 0; i < VALUES; i++) {
            double difference = m[e].value[i] - m[0].value[i], error = hypot(m[e].error[i], m[0].error[i]);
            if (fabs(difference) > deviations * error + 1e-5 * m[0].value[i])
                fail_msg("estimator %d, value %d: %.5f ± %.5f, MIS says %.5f ± %.5f", e, i, m[e].value[i], m[e].error[i],
                         m[0].value[i], m[0].error[i]);
        }
}

static kiln_material emitter(float radiance) {
    kiln_material m = diffuse_material(0.3f, 0.3f, 0.3f);
    for (int k = 0; k < 3; k++) m.emission.value[k] = radiance;
    return m;
}
static kiln_material metal(float roughness) {
    kiln_material m = kiln_material_default();
    m.roughness.value = roughness;
    m.base_color.value[1] = 0.8f, m.base_color.value[2] = 0.6f;
    return m;
}
static kiln_material glass(float roughness) {
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME;
    m.metallic.value = 0, m.roughness.value = roughness, m.transmission.value = 1, m.thickness.value = 1;
    m.attenuation_distance = 1, m.attenuation_color[0] = 0.5f;
    return m;
}

/* A box open to the camera's side, with a lamp under its ceiling. */
static void add_room(scene_builder *b, const kiln_material *lamp) {
    kiln_material white = diffuse_material(0.7f, 0.7f, 0.7f), red = diffuse_material(0.7f, 0.1f, 0.1f);
    kiln_id w = add_material(b, &white), r = add_material(b, &red);
    add_quad(b, w, (float[]){-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1});
    add_quad(b, w, (float[]){-1, 2, -1, 1, 2, -1, 1, 2, 1, -1, 2, 1});
    add_quad(b, w, (float[]){-1, 0, -1, 1, 0, -1, 1, 2, -1, -1, 2, -1});
    add_quad(b, r, (float[]){-1, 0, 1, -1, 0, -1, -1, 2, -1, -1, 2, 1});
    add_quad(b, w, (float[]){1, 0, -1, 1, 0, 1, 1, 2, 1, 1, 2, -1});
    add_quad(b, add_material(b, lamp), (float[]){-.4f, 1.9f, -.4f, .4f, 1.9f, -.4f, .4f, 1.9f, .4f, -.4f, 1.9f, .4f});
}
static kiln_camera room_camera(void) { return camera_at((float[]){0, 1, 3.6f}, (float[]){0, 0.9f, 0}, 40); }

static void build_diffuse(scene_builder *b) {
    kiln_material lamp = emitter(6);
    add_room(b, &lamp);
    kiln_material grey = diffuse_material(0.5f, 0.5f, 0.5f);
    add_box(b, add_material(b, &grey), (float[]){-.5f, 0, -.5f}, (float[]){.1f, .8f, .1f});
}
static void diffuse_room(void **state) {
    (void)state;
    kiln_camera view = room_camera();
    compare(build_diffuse, &view, (uint32_t[]){128, 128, 512});
}

/* Mirror and glass: lamps in mirrors, light through glass, and their caustics, which only BSDF samples find. */
static void build_specular(scene_builder *b) {
    kiln_material lamp = emitter(6), mirror = metal(0), clear = glass(0);
    add_room(b, &lamp);
    add_sphere(b, add_material(b, &mirror), (float[]){-.4f, .4f, -.3f}, .4f, 24, 0);
    add_sphere(b, add_material(b, &clear), (float[]){.4f, .4f, .3f}, .35f, 24, 0);
    add_quad(b, add_material(b, &mirror), (float[]){.98f, .5f, -.6f, .98f, .5f, .6f, .98f, 1.5f, .6f, .98f, 1.5f, -.6f});
}
static void specular_chains(void **state) {
    (void)state;
    kiln_camera view = room_camera();
    compare(build_specular, &view, (uint32_t[]){512, 512, 512});
}

/* What the rule for specular bounces is for: without it light is lost, or counted twice. */
static void wrong_estimators_are_wrong(void **state) {
    (void)state;
    static const kiln_estimator estimators[] = {KILN_ESTIMATOR_MIS, KILN_ESTIMATOR_NAIVE, KILN_ESTIMATOR_DOUBLED};
    kiln_camera view = room_camera();
    means m[3];
    for (int e = 0; e < 3; e++) {
        scene_builder b = builder_make();
        build_specular(&b);
        kiln_render_options o = {.spp = 64, .estimator = estimators[e], .seed = 1, .max_depth = 6};
        picture p = render(&b, &view, &o, SIDE, SIDE);
        m[e] = measure(p.film);
        picture_free(&p);
        builder_free(&b);
    }
    const double right = m[0].value[VALUES - 1], error = m[0].error[VALUES - 1];
    assert_true(m[1].value[VALUES - 1] < right - deviations * (error + m[1].error[VALUES - 1]));
    assert_true(m[2].value[VALUES - 1] > right + deviations * (error + m[2].error[VALUES - 1]));
}

static void build_textured(scene_builder *b) {
    float pixels[16 * 3];
    for (int i = 0; i < 16; i++)
        for (int k = 0; k < 3; k++) pixels[3 * i + k] = (i * 7 + k * 3) % 5 == 0 ? 4.0f : 0.1f * (float)(i % 3);
    kiln_material lamp = emitter(4), shiny = metal(0.3f);
    lamp.emission.texture = (kiln_texture){.image = add_image(b, pixels, 4, 4), .transfer = KILN_TRANSFER_LINEAR};
    add_room(b, &lamp);
    add_sphere(b, add_material(b, &shiny), (float[]){0, .5f, 0}, .5f, 24, 0);
}
/* Lamps below a clear coat: one that stands upright between mirrors, and is seen and shines along itself. */
static void build_coated(scene_builder *b) {
    const float checks[4 * 3] = {1, 1, 1, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 1, 1, 1};
    kiln_material lamp = emitter(6), wall = metal(0.5f);
    lamp.layers = KILN_LAYER_CLEARCOAT, lamp.clearcoat.value = 1, lamp.clearcoat_roughness.value = 0.4f;
    lamp.clearcoat.texture = (kiln_texture){.image = add_image(b, checks, 2, 2), .transfer = KILN_TRANSFER_DATA};
    lamp.double_sided = true;
    kiln_id w = add_material(b, &wall);
    add_quad(b, w, (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    add_quad(b, w, (float[]){-2, 2, -2, 2, 2, -2, 2, 2, 2, -2, 2, 2});
    add_quad(b, add_material(b, &lamp), (float[]){0, .1f, .9f, 0, .1f, -.9f, 0, 1.9f, -.9f, 0, 1.9f, .9f});
}
static void coated_lamp(void **state) {
    (void)state;
    kiln_camera view = camera_at((float[]){0.6f, 1, 3.6f}, (float[]){0, 0.9f, 0}, 40);
    compare(build_coated, &view, (uint32_t[]){256, 512, 1024});
}
static void textured_emitter(void **state) {
    (void)state;
    kiln_camera view = room_camera();
    compare(build_textured, &view, (uint32_t[]){128, 256, 1024});
}

static void build_sun(scene_builder *b) {
    kiln_material ground = diffuse_material(0.5f, 0.5f, 0.5f), shiny = metal(0.25f), clear = glass(0), mirror = metal(0);
    add_quad(b, add_material(b, &ground), (float[]){-4, 0, 4, 4, 0, 4, 4, 0, -4, -4, 0, -4});
    add_sphere(b, add_material(b, &shiny), (float[]){-.7f, .5f, 0}, .5f, 24, 0);
    add_sphere(b, add_material(b, &clear), (float[]){.6f, .5f, 0}, .45f, 24, 0);
    add_sphere(b, add_material(b, &mirror), (float[]){0, .3f, .8f}, .3f, 24, 0);
    kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[]){2, 3, 1}, (float[]){0, 0, 0}, 3);
    sun.angle_rad = 0.15f; /* 1/700 of the hemisphere; the real one is 250 times smaller still */
    add_light(b, &sun);
    set_environment(b, 0, 0.2f, 0.3f, 0.4f);
}
/* Lamps that are there in part: a veil whose alpha is a picture, and a sheet with holes. */
static void build_partial(scene_builder *b) {
    float alpha[16 * 3];
    for (int i = 0; i < 48; i++) alpha[i] = (float)(i / 3 * 7 % 16) / 15.0f;
    kiln_id holes = add_image(b, alpha, 4, 4);
    kiln_material lamp = emitter(6), sheet = emitter(2);
    lamp.alpha_mode = KILN_ALPHA_BLEND, lamp.opacity.value = 0.6f;
    lamp.opacity.texture = (kiln_texture){.image = holes, .transfer = KILN_TRANSFER_DATA};
    sheet.alpha_mode = KILN_ALPHA_MASK, sheet.alpha_cutoff = 0.5f, sheet.opacity.texture = lamp.opacity.texture;
    add_room(b, &lamp);
    add_quad(b, add_material(b, &sheet), (float[]){.2f, .4f, -.9f, .9f, .4f, -.9f, .9f, 1.1f, -.9f, .2f, 1.1f, -.9f});
}
static void partial_emitters(void **state) {
    (void)state;
    kiln_camera view = room_camera();
    compare(build_partial, &view, (uint32_t[]){128, 256, 1024});
}

static void small_sun(void **state) {
    (void)state;
    kiln_camera view = camera_at((float[]){0, 1.5f, 4}, (float[]){0, 0.4f, 0}, 35);
    compare(build_sun, &view, (uint32_t[]){256, 256, 4096});
}

static void build_environment(scene_builder *b) {
    float sky[16 * 8 * 3];
    for (int i = 0; i < 16 * 8; i++)
        for (int k = 0; k < 3; k++) sky[3 * i + k] = i == 37 ? 20.0f : 0.1f + 0.02f * (float)((i * 13 + k) % 17);
    kiln_material ground = metal(0.5f), plastic = diffuse_material(0.2f, 0.4f, 0.7f), shiny = metal(0.1f);
    plastic.specular.value = 1, plastic.roughness.value = 0.2f;
    add_quad(b, add_material(b, &ground), (float[]){-4, 0, 4, 4, 0, 4, 4, 0, -4, -4, 0, -4});
    add_sphere(b, add_material(b, &plastic), (float[]){-.6f, .5f, 0}, .5f, 24, 0);
    add_sphere(b, add_material(b, &shiny), (float[]){.6f, .5f, 0}, .5f, 24, 0);
    set_environment(b, add_image(b, sky, 16, 8), 1, 1, 1);
}
static void glossy_under_a_sky(void **state) {
    (void)state;
    kiln_camera view = camera_at((float[]){0, 1.5f, 4}, (float[]){0, 0.4f, 0}, 35);
    compare(build_environment, &view, (uint32_t[]){256, 512, 2048});
}

/* Rough glass that absorbs, a rough thin wall, partial coverage. */
static void build_translucent(scene_builder *b) {
    kiln_material lamp = emitter(6), frosted = glass(0.3f), film = glass(0.2f), veil = diffuse_material(0.6f, 0.6f, 0.2f);
    film.layers = KILN_LAYER_TRANSMISSION;
    veil.alpha_mode = KILN_ALPHA_BLEND, veil.opacity.value = 0.4f, veil.double_sided = true;
    add_room(b, &lamp);
    add_sphere(b, add_material(b, &frosted), (float[]){-.3f, .5f, -.2f}, .45f, 24, SPHERE_FLAT);
    add_quad(b, add_material(b, &film), (float[]){.2f, .1f, .6f, .8f, .1f, .3f, .8f, 1.1f, .3f, .2f, 1.1f, .6f});
    add_quad(b, add_material(b, &veil), (float[]){-.9f, 1.2f, -.5f, .9f, 1.2f, -.5f, .9f, 1.2f, .5f, -.9f, 1.2f, .5f});
}
static void translucent(void **state) {
    (void)state;
    kiln_camera view = room_camera();
    compare(build_translucent, &view, (uint32_t[]){256, 512, 1024});
}

/* Lamps of all sizes that face all ways, of one side and of two, points and spots, a sun and a sky: all that a tree of
 * lights tells apart, for points on gloss, in frosted glass and on what is diffuse. */
static void build_many(scene_builder *b) {
    kiln_material white = diffuse_material(0.7f, 0.7f, 0.7f), shiny = metal(0.25f), frosted = glass(0.3f);
    kiln_id wall = add_material(b, &white), lamps[4];
    for (int k = 0; k < 4; k++) {
        kiln_material lamp = emitter(ldexpf(2, k));
        lamp.double_sided = k == 3;
        lamps[k] = add_material(b, &lamp);
    }
    add_quad(b, wall, (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    add_quad(b, wall, (float[]){-2, 0, -1.5f, 2, 0, -1.5f, 2, 2, -1.5f, -2, 2, -1.5f});
    add_sphere(b, add_material(b, &shiny), (float[]){-.6f, .5f, 0}, .45f, 16, 0);
    add_sphere(b, add_material(b, &frosted), (float[]){.6f, .5f, 0.3f}, .4f, 16, 0);
    stream random = {77, 0};
    for (int i = 0; i < 40; i++) {
        vec3 p = {stream_between(&random, -1.5f, 1.5f), stream_between(&random, 0.05f, 2), stream_between(&random, -1.4f, 1)};
        vec3 x = v3_scale(stream_direction(&random), 0.3f * stream_next(&random));
        vec3 y = v3_scale(stream_direction(&random), i % 3 == 0 ? 0.6f : 0.15f), c = v3_add(v3_add(p, x), y);
        add_quad(b, lamps[i % 4], (float[]){p.x, p.y, p.z, p.x + x.x, p.y + x.y, p.z + x.z, c.x, c.y, c.z, p.x + y.x,
                                            p.y + y.y, p.z + y.z});
    }
    for (int i = 0; i < 4; i++) {
        kiln_light l = light_at(i & 1 ? KILN_LIGHT_SPOT : KILN_LIGHT_POINT, (float[]){(float)i - 1.5f, 1.2f, 0.5f},
                                (float[]){0, 0, 0}, 0.5f);
        l.outer_cone_rad = 0.6f, l.inner_cone_rad = 0.1f;
        add_light(b, &l);
    }
    kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[]){2, 3, 1}, (float[]){0, 0, 0}, 1);
    sun.angle_rad = 0.3f;
    add_light(b, &sun);
    set_environment(b, 0, 0.2f, 0.3f, 0.4f);
}
static void many_lights(void **state) {
    (void)state;
    kiln_camera view = camera_at((float[]){0, 1.3f, 4}, (float[]){0, 0.8f, 0}, 40);
    compare(build_many, &view, (uint32_t[]){256, 512, 1024});
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(diffuse_room),     cmocka_unit_test(specular_chains),
                                       cmocka_unit_test(wrong_estimators_are_wrong),
                                       cmocka_unit_test(textured_emitter), cmocka_unit_test(partial_emitters),
                                       cmocka_unit_test(small_sun),
                                       cmocka_unit_test(glossy_under_a_sky), cmocka_unit_test(translucent),
                                       cmocka_unit_test(coated_lamp),      cmocka_unit_test(many_lights)};
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
