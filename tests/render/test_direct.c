/* Direct light on a diffuse floor against closed forms. Outgoing radiance is ρ E/π; E is irradiance. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "tests/render/scenes.h"

static const float albedo = 0.6f;

/* A large floor at y = 0 and a camera that sees a spot of it, small enough to count as the origin. */
static scene_builder floor_scene(void) {
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(albedo, albedo, albedo);
    add_quad(&b, add_material(&b, &m), (float[]){-50, 0, 50, 50, 0, 50, 50, 0, -50, -50, 0, -50});
    return b;
}

/* Mean radiance of the spot, times π/ρ: the irradiance there. */
static void expect_irradiance(scene_builder *b, double expected, kiln_estimator estimator, uint32_t spp, const char *what) {
    kiln_camera view = camera_at((float[]){0.3f, 2, 0.1f}, (float[]){0, 0, 0}, 0.02);
    picture p = render(b, &view, &(kiln_render_options){.spp = spp, .estimator = estimator, .max_depth = 1}, 16, 16);
    double got = p.mean * M_PI / (double)albedo, error = p.mean_error * M_PI / (double)albedo;
    if (fabs(got - expected) > 3.9 * error + 2e-5 * expected) /* 1 in 10,000; rounding and the spot's size */
        fail_msg("%s: irradiance %.6f ± %.6f, expected %.6f", what, got, error, expected);
    picture_free(&p);
    builder_free(b);
}

/* E = I cos/r² */
static void point_light(void **state) {
    (void)state;
    scene_builder b = floor_scene();
    kiln_light l = light_at(KILN_LIGHT_POINT, (float[]){1, 2, 2}, (float[]){0, 0, 0}, 7);
    add_light(&b, &l);
    expect_irradiance(&b, 7.0 * (2.0 / 3) / 9, KILN_ESTIMATOR_MIS, 16, "point");
}

/* Inside the inner cone as a point light; between the cones clamp((cos − cos outer)/(cos inner − cos outer))². */
static void spot_light(void **state) {
    (void)state;
    const double aims[] = {0, 0.2, 0.35, 0.6}, inner = 0.25, outer = 0.5; /* radians off the axis */
    for (int i = 0; i < 4; i++) {
        scene_builder b = floor_scene();
        kiln_light l = light_at(KILN_LIGHT_SPOT, (float[]){0, 2, 0}, (float[]){(float)(2 * tan(aims[i])), 0, 0}, 5);
        l.inner_cone_rad = (float)inner, l.outer_cone_rad = (float)outer;
        add_light(&b, &l);
        double edge = fmin(fmax((cos(aims[i]) - cos(outer)) / (cos(inner) - cos(outer)), 0), 1);
        expect_irradiance(&b, 5.0 / 4 * edge * edge, KILN_ESTIMATOR_MIS, 16, "spot");
    }
}

/* Illuminance times cos, whether the beam is parallel or the sun has a size (E is given on a surface that faces it; a
 * disk of half angle a whose centre is at θ gives E cos θ as long as it is above the horizon). */
static void sun(void **state) {
    (void)state;
    const float angles[] = {0, 0.0093f, 0.5f};
    const kiln_estimator estimators[] = {KILN_ESTIMATOR_MIS, KILN_ESTIMATOR_NEE};
    for (int i = 0; i < 3; i++)
        for (int e = 0; e < 2; e++) {
            scene_builder b = floor_scene();
            kiln_light l = light_at(KILN_LIGHT_DISTANT, (float[]){3, 4, 0}, (float[]){0, 0, 0}, 11);
            l.angle_rad = angles[i];
            add_light(&b, &l);
            expect_irradiance(&b, 11 * 0.8, estimators[e], 256, "sun");
        }
}

/* A wide sun by BSDF samples alone. */
static void sun_by_chance(void **state) {
    (void)state;
    scene_builder b = floor_scene();
    kiln_light l = light_at(KILN_LIGHT_DISTANT, (float[]){3, 4, 0}, (float[]){0, 0, 0}, 11);
    l.angle_rad = 1;
    add_light(&b, &l);
    expect_irradiance(&b, 11 * 0.8, KILN_ESTIMATOR_BSDF, 1024, "wide sun by BSDF samples");
}

/* Parallel rectangle centred above: E = 4 L (A atan B + …)/2 for a quarter, A = a/√(a² + h²) …
 * (Howell's catalogue of view factors, B-3): quarter a × b at height h:
 * F = 1/2π (a/√(h²+a²) atan(b/√(h²+a²)) + b/√(h²+b²) atan(a/√(h²+b²))), E = 4 π L F. */
static void rectangle(void **state) {
    (void)state;
    const kiln_estimator estimators[] = {KILN_ESTIMATOR_MIS, KILN_ESTIMATOR_NEE, KILN_ESTIMATOR_BSDF};
    const double a = 0.5, c = 0.8, h = 1, l = 3;
    double p = sqrt(h * h + a * a), q = sqrt(h * h + c * c);
    double view = (a / p * atan(c / p) + c / q * atan(a / q)) / (2 * M_PI);
    for (int e = 0; e < 3; e++) {
        scene_builder b = floor_scene();
        kiln_material m = diffuse_material(0, 0, 0);
        for (int k = 0; k < 3; k++) m.emission.value[k] = (float)l;
        add_quad(&b, add_material(&b, &m), (float[]){-.5f, 1, -.8f, .5f, 1, -.8f, .5f, 1, .8f, -.5f, 1, .8f});
        expect_irradiance(&b, 4 * M_PI * l * view, estimators[e], estimators[e] == KILN_ESTIMATOR_BSDF ? 1024 : 256, "rectangle");
    }
}

/* Rows of constant texels, brighter towards the horizon: E = 2π ∫ L(θ) sin θ cos θ dθ, L as the bilinear look-up blends
 * neighbouring rows. */
static void environment(void **state) {
    (void)state;
    enum { W = 4, H = 64 };
    float rgb[W * H * 3];
    double expected = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int k = 0; k < 3; k++) rgb[(y * W + x) * 3 + k] = y < 20 ? 0.2f + 0.15f * (float)y : 0.5f;
    enum { STEPS = 200000 };
    for (int i = 0; i < STEPS; i++) { /* midpoint rule over θ of the bilinear look-up */
        double theta = (i + 0.5) / STEPS * M_PI / 2, at = theta / M_PI * H - 0.5;
        int row = (int)floor(at);
        double t = at - row, low = rgb[(row < 0 ? 0 : row) * W * 3], high = rgb[(row + 1) * W * 3];
        expected += (low + t * (high - low)) * 2 * M_PI * sin(theta) * cos(theta) * M_PI / 2 / STEPS;
    }
    const kiln_estimator estimators[] = {KILN_ESTIMATOR_MIS, KILN_ESTIMATOR_NEE, KILN_ESTIMATOR_BSDF};
    for (int e = 0; e < 3; e++) {
        scene_builder b = floor_scene();
        set_environment(&b, add_image(&b, rgb, W, H), 1, 1, 1);
        expect_irradiance(&b, expected, estimators[e], 256, "environment");
    }
}

/* E = π L under a constant sky, whatever the estimator. */
static void constant_sky(void **state) {
    (void)state;
    scene_builder b = floor_scene();
    set_environment(&b, 0, 0.7f, 0.7f, 0.7f);
    expect_irradiance(&b, M_PI * (double)0.7f, KILN_ESTIMATOR_MIS, 64, "constant sky");
}

/* Absorption after Beer: a slab of IOR 1, 0.2 m thick, that leaves a quarter of the light after 0.1 m, in front of a
 * floor that shines: L = 1 · 0.25². */
static void absorbing_slab(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material lamp = diffuse_material(0, 0, 0), slab = kiln_material_default();
    for (int k = 0; k < 3; k++) lamp.emission.value[k] = 1, slab.attenuation_color[k] = 0.25f;
    slab.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME;
    slab.metallic.value = 0, slab.roughness.value = 0, slab.transmission.value = 1, slab.thickness.value = 1;
    slab.ior = 1, slab.specular.value = 0, slab.attenuation_distance = 0.1f;
    add_quad(&b, add_material(&b, &lamp), (float[]){-5, 0, 5, 5, 0, 5, 5, 0, -5, -5, 0, -5});
    add_box(&b, add_material(&b, &slab), (float[]){-1, 0.5f, -1}, (float[]){1, 0.7f, 1});
    kiln_camera view = camera_at((float[]){0, 3, 0}, (float[]){0, 0, 0}, 0.1);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 4, .roulette = {.kind = KILN_ROULETTE_OFF}}, 8, 8);
    assert_float_equal((float)p.mean, 0.0625f, 1e-6f);
    picture_free(&p);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(point_light), cmocka_unit_test(spot_light), cmocka_unit_test(sun),
                                       cmocka_unit_test(sun_by_chance), cmocka_unit_test(rectangle),
                                       cmocka_unit_test(environment), cmocka_unit_test(constant_sky),
                                       cmocka_unit_test(absorbing_slab)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
