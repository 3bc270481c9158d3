/* Furnaces: light that is the same everywhere stays so, whatever white things are in it.
 *
 * The inside of a closed diffuse sphere of albedo ρ that emits E everywhere sees radiance E/(1 − ρ): the sum of the
 * geometric series of bounces (the furnace test). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "tests/render/scenes.h"

static const float origin[3] = {0, 0, 0}, ahead[3] = {0, 0.3f, -1};

static picture furnace(float albedo, const kiln_render_options *options) {
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(albedo, albedo, albedo);
    for (int k = 0; k < 3; k++) m.emission.value[k] = 1;
    add_sphere(&b, add_material(&b, &m), origin, 1, 32, SPHERE_INWARD | SPHERE_FLAT);
    kiln_camera view = camera_at(origin, ahead, 70);
    picture p = render(&b, &view, options, 16, 16);
    builder_free(&b);
    return p;
}

static void sees_two(void **state) {
    (void)state;
    const kiln_estimator estimators[] = {KILN_ESTIMATOR_BSDF, KILN_ESTIMATOR_NEE, KILN_ESTIMATOR_MIS};
    const kiln_sampler samplers[] = {KILN_SAMPLER_SOBOL, KILN_SAMPLER_INDEPENDENT};
    const kiln_light_sampling choices[] = {KILN_LIGHTS_TREE, KILN_LIGHTS_POWER, KILN_LIGHTS_UNIFORM};
    for (int e = 0; e < 3; e++)
        for (int s = 0; s < 2; s++)
            for (int c = 0; c < 3; c++) {
                kiln_render_options o = {.spp = 128, .estimator = estimators[e], .sampler = samplers[s],
                                         .light_sampling = choices[c], .roulette = {.kind = KILN_ROULETTE_OFF}, .max_depth = 24};
                picture p = furnace(0.5f, &o);
                if (fabs(p.mean - 2) > 3.9 * p.mean_error + 1e-5) /* 1 in 10,000 */
                    fail_msg("estimator %d, sampler %d, lights %d: %.5f ± %.5f", e, s, c, p.mean, p.mean_error);
                picture_free(&p);
            }
}

/* A white layer stack on a ball, and how much less than 1 it may give back on the average over what is seen of it. */
typedef struct stack {
    const char *name;
    unsigned layers;
    float transmission, roughness, clearcoat_roughness, ior;
    double loss;
} stack;

enum {
    LEAF = KILN_LAYER_DIFFUSE_TRANSMISSION,
    WAX = LEAF | KILN_LAYER_VOLUME,
    FOG = WAX | KILN_LAYER_VOLUME_SCATTER,
    GLASS = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME,
    COAT = KILN_LAYER_CLEARCOAT,
    FILM = KILN_LAYER_IRIDESCENCE
};

static const stack stacks[] = {
    {"plastic", 0, 0, 0.5f, 0, 1.5f, 5e-3},
    {"clear coat on white", COAT, 0, 0.5f, 0, 1.5f, 1e-2},
    {"rough clear coat on white", COAT, 0, 0.5f, 0.5f, 1.5f, 1e-2},
    {"leaf", LEAF, 0, 0.5f, 0, 1.5f, 1e-2},
    {"wax", WAX, 0, 0.5f, 0, 1.4f, 2e-2},
    {"wax that scatters within", FOG, 0, 0.5f, 0, 1.4f, 2e-2},
    {"glass", GLASS, 1, 0.3f, 0, 1.5f, 2e-2},
    {"film on rough glass", GLASS | FILM, 1, 0.5f, 0, 1.5f, 7e-2},
    {"clear coat on a wax that scatters", FOG | COAT, 0, 0.5f, 0.2f, 1.4f, 1}, /* what it sends back in is lost */
    {"clear coat on glass", GLASS | COAT, 1, 0.3f, 0.1f, 1.5f, 1},
};

static kiln_material stack_material(const stack *s) {
    kiln_material m = kiln_material_default();
    m.layers = s->layers;
    m.metallic.value = 0, m.roughness.value = s->roughness, m.transmission.value = s->transmission;
    m.ior = s->ior;
    m.clearcoat.value = 1, m.clearcoat_roughness.value = s->clearcoat_roughness;
    m.diffuse_transmission.value = 0.6f;
    m.thickness.value = 1;
    m.iridescence.value = 1, m.iridescence_ior = 1.8f, m.iridescence_thickness[1] = 400;
    if (s->layers & KILN_LAYER_VOLUME_SCATTER) {
        m.attenuation_distance = 1;
        for (int k = 0; k < 3; k++) m.attenuation_color[k] = 0.3f, m.multiscatter_color[k] = 1;
    }
    m.double_sided = true;
    return m;
}

static void white_stacks_are_hardly_seen(void **state) {
    (void)state;
    const float eye[3] = {0, 0, 4}, sky[3] = {1, 1, 1};
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++) {
        scene_builder b = builder_make();
        kiln_material m = stack_material(&stacks[i]);
        add_sphere(&b, add_material(&b, &m), origin, 1, 48, SPHERE_FLAT);
        set_environment(&b, add_image(&b, sky, 1, 1), 1, 1, 1);
        kiln_camera view = camera_at(eye, origin, 29); /* the sides touch its rim, the corners see past it */
        kiln_render_options o = {.spp = 256, .max_depth = 400};
        picture p = render(&b, &view, &o, 16, 16);
        double noise = 3.9 * p.mean_error;
        print_message("%s: %.5f ± %.5f\n", stacks[i].name, p.mean, p.mean_error);
        if (!(p.mean <= 1 + 5e-3 + noise) || !(p.mean >= 1 - stacks[i].loss - noise))
            fail_msg("%s: gives back %.5f ± %.5f", stacks[i].name, p.mean, p.mean_error);
        picture_free(&p);
        builder_free(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(sees_two), cmocka_unit_test(white_stacks_are_hardly_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
