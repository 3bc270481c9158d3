/* The inside of a closed diffuse sphere of albedo ρ that emits E everywhere sees radiance E/(1 − ρ): the sum of the
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
    const kiln_light_sampling choices[] = {KILN_LIGHTS_POWER, KILN_LIGHTS_UNIFORM};
    for (int e = 0; e < 3; e++)
        for (int s = 0; s < 2; s++)
            for (int c = 0; c < 2; c++) {
                kiln_render_options o = {.spp = 128, .estimator = estimators[e], .sampler = samplers[s],
                                         .light_sampling = choices[c], .roulette = {.kind = KILN_ROULETTE_OFF}, .max_depth = 24};
                picture p = furnace(0.5f, &o);
                if (fabs(p.mean - 2) > 3.9 * p.mean_error + 1e-5) /* 1 in 10,000 */
                    fail_msg("estimator %d, sampler %d, lights %d: %.5f ± %.5f", e, s, c, p.mean, p.mean_error);
                picture_free(&p);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(sees_two)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
