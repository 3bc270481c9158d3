/* Every roulette policy has the expectation of none, and ends paths; the depth limit's lost energy is measured. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "render/path/path.h"
#include "render/path/roulette.h"
#include "tests/render/scenes.h"

static const float origin[3] = {0, 0, 0}, ahead[3] = {0, 0.3f, -1};

/* Inside a closed flat-shaded sphere of albedo ρ that emits E everywhere. */
static picture furnace(float albedo, float emission, const kiln_render_options *options) {
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(albedo, albedo * 0.9f, albedo * 0.5f);
    for (int k = 0; k < 3; k++) m.emission.value[k] = emission;
    add_sphere(&b, add_material(&b, &m), origin, 1, 24, SPHERE_INWARD | SPHERE_FLAT);
    kiln_camera view = camera_at(origin, ahead, 70);
    kiln_render_options o = *options;
    o.estimator = KILN_ESTIMATOR_BSDF;
    picture p = render(&b, &view, &o, 16, 16);
    builder_free(&b);
    return p;
}

/* Mean over the channels of E/(1 − ρ). */
static double closed_form(double albedo) {
    return (1 / (1 - albedo) + 1 / (1 - 0.9 * albedo) + 1 / (1 - 0.5 * albedo)) / 3;
}

static void is_unbiased(void **state) {
    (void)state;
    const kiln_roulette policies[] = {{.kind = KILN_ROULETTE_OFF},
                                      {.kind = KILN_ROULETTE_FIXED, .p = 0.95},
                                      {.kind = KILN_ROULETTE_FIXED, .p = 0.6},
                                      {.kind = KILN_ROULETTE_THROUGHPUT},
                                      {.kind = KILN_ROULETTE_THROUGHPUT, .min_depth = 5},
                                      {.kind = KILN_ROULETTE_AUTO}};
    uint64_t rays_of_off = 0;
    for (int i = 0; i < 6; i++) {
        picture p = furnace(0.8f, 1, &(kiln_render_options){.spp = 128, .roulette = policies[i], .max_depth = 200});
        double expected = closed_form(0.8);
        if (fabs(p.mean - expected) > 3.9 * p.mean_error + 1e-5) /* 1 in 10,000 */
            fail_msg("policy %d: %.5f ± %.5f, expected %.5f", i, p.mean, p.mean_error, expected);
        if (i == 0) rays_of_off = p.stats.bounce_rays;
        else assert_true(p.stats.bounce_rays < rays_of_off / (policies[i].kind == KILN_ROULETTE_AUTO ? 3 : 4));
        picture_free(&p);
    }
}

/* Two mirrors that absorb nothing face each other: paths end all the same (0.99 at most survive), and nothing is lost. */
static void ends_between_mirrors(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material mirror = kiln_material_default();
    mirror.roughness.value = 0;
    kiln_id m = add_material(&b, &mirror);
    add_box(&b, m, (float[]){-1, -1, -1}, (float[]){1, 1, 1});
    kiln_camera view = camera_at(origin, ahead, 60);
    view.znear = 0;
    kiln_material two_sided = mirror;
    two_sided.double_sided = true;
    add_sphere(&b, add_material(&b, &two_sided), origin, 0.9f, 16, SPHERE_FLAT);
    picture p = render(&b, &view, &(kiln_render_options){.spp = 4, .max_depth = 100000}, 8, 8);
    assert_true(p.mean == 0);
    double per_path = (double)p.stats.bounce_rays / (double)p.stats.camera_rays;
    assert_true(per_path > 30 && per_path < 400); /* one guaranteed, then 0.99 each: 101 on average */
    picture_free(&p);
    builder_free(&b);
}

/* A limit of D scattering events keeps E (1 − ρ^(D+1))/(1 − ρ): the share that is reported lost is ρ^(D+1). */
static void reports_what_the_limit_cuts(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(0.8f, 0.8f, 0.8f);
    for (int k = 0; k < 3; k++) m.emission.value[k] = 1;
    add_sphere(&b, add_material(&b, &m), origin, 1, 24, SPHERE_INWARD | SPHERE_FLAT);
    kiln_camera view = camera_at(origin, ahead, 70);
    const uint32_t depths[] = {KILN_DEPTH_ZERO, 1, 4, 9};
    const double scatterings[] = {0, 1, 4, 9};
    for (int i = 0; i < 4; i++) {
        kiln_render_options o = {.spp = 256, .max_depth = depths[i], .estimator = KILN_ESTIMATOR_BSDF,
                                 .roulette = {.kind = KILN_ROULETTE_OFF}};
        picture p = render(&b, &view, &o, 32, 32);
        double lost = pow(0.8, scatterings[i] + 1);
        assert_float_equal((float)p.mean, (float)((1 - lost) / 0.2), 1e-4f);
        /* One path in 32 is a probe: 8,192 of them, each with roulette of its own. */
        if (fabs(p.stats.lost_energy - lost) > 0.05 * lost)
            fail_msg("depth %g: lost %.4f, expected %.4f", scatterings[i], p.stats.lost_energy, lost);
        picture_free(&p);
    }
    builder_free(&b);
}

/* survival · weight = 1, and the policies' own rules. */
static void survives_as_stated(void **state) {
    (void)state;
    path_context c = {.max_depth = 64, .roulette = KILN_ROULETTE_THROUGHPUT, .roulette_min = 3};
    const vec3 dim = {0.1f, 0.3f, 0.2f}, bright = {5, 1, 1}, black = {0, 0, 0};
    roulette r = roulette_make(&c, 2);
    assert_true(roulette_survival(&r, dim, 1) == 1.0f); /* guaranteed */
    r = roulette_make(&c, 3);
    assert_true(roulette_survival(&r, dim, 1) == 0.3f); /* the largest channel */
    assert_true(roulette_survival(&r, dim, 2.25f) == 0.3f * 2.25f); /* what refraction squeezed comes back */
    assert_true(roulette_survival(&r, bright, 1) == ROULETTE_MOST);
    assert_true(roulette_survival(&r, black, 1) == 1.0f);
    assert_true(roulette_weight(&r, dim, 1, 0.29f) == 1.0f / 0.3f);
    assert_true(roulette_weight(&r, dim, 1, 0.31f) == 0.0f);
    c.roulette = KILN_ROULETTE_AUTO;
    r = roulette_make(&c, 0);
    assert_true(roulette_survival(&r, dim, 1) == 1.0f);
    r = roulette_make(&c, 1);
    assert_true(fabs((double)roulette_survival(&r, dim, 1) - 1.5 * sqrt(0.3)) < 1e-6);
    assert_true(roulette_survival(&r, bright, 1) == ROULETTE_MOST);
    c.roulette = KILN_ROULETTE_FIXED, c.roulette_p = 0.6f;
    r = roulette_make(&c, 0);
    assert_true(roulette_survival(&r, bright, 1) == 0.6f);
    c.roulette = KILN_ROULETTE_OFF;
    r = roulette_make(&c, 60);
    assert_true(roulette_survival(&r, dim, 1) == 1.0f);
    r = roulette_make(&c, 64); /* probes beyond the limit end whatever the policy */
    assert_true(roulette_survival(&r, dim, 1) == 0.3f);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(is_unbiased), cmocka_unit_test(ends_between_mirrors),
                                       cmocka_unit_test(reports_what_the_limit_cuts), cmocka_unit_test(survives_as_stated)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
