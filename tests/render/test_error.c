/* The error that a film reports against the error that it has: one scene, many seeds, and a reference of far more
 * samples. Levels are stated; seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE, SEEDS = 200, SPP = 16, REFERENCE_SPP = 1 << 12 };

/* A floor and a ball under a lamp and a little sky: soft shadows, indirect light. */
static kiln_renderer *room(scene_builder *b) {
    *b = builder_make();
    kiln_material floor = diffuse_material(0.7f, 0.6f, 0.5f), ball = diffuse_material(0.3f, 0.5f, 0.7f), lamp = ball;
    for (int k = 0; k < 3; k++) lamp.emission.value[k] = 6;
    add_quad(b, add_material(b, &floor), (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    add_quad(b, add_material(b, &lamp), (float[]){-.6f, 2, -.6f, .6f, 2, -.6f, .6f, 2, .6f, -.6f, 2, .6f});
    add_sphere(b, add_material(b, &ball), (float[]){0, 0.5f, 0}, 0.5f, 16, 0);
    set_environment(b, 0, 0.1f, 0.1f, 0.1f);
    must(kiln_scene_commit(b->scene, b->report), b->report, "committing");
    kiln_renderer *r;
    must(kiln_renderer_create(b->scene, NULL, &r, b->report), b->report, "making a renderer");
    return r;
}

static picture shoot(const kiln_renderer *r, kiln_report *report, uint32_t spp, uint64_t seed, kiln_sampler sampler) {
    kiln_camera view = camera_at((float[]){0, 2, 4}, (float[]){0, 0.5f, 0}, 40);
    kiln_render_options o = {.camera = &view, .spp = spp, .seed = seed, .sampler = sampler, .max_depth = 3};
    return render_with(r, &o, &(kiln_film_desc){.width = SIDE, .height = SIDE}, report);
}

static double true_relmse(const picture *p, const picture *reference) {
    double sum = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        double ref = (double)reference->rgb[i], d = (double)p->rgb[i] - ref;
        sum += d * d / (ref * ref + 0.01);
    }
    return sum / (3 * PIXELS);
}

/* Over the seeds the estimate has the mean of the true error, but for what the estimate takes from the picture itself
 * instead of the reference (four per cent at this noise); and its interval, said to be of 95 %, covers that mean in at
 * least so many of the runs as a binomial law of 95 % would but in one case in a thousand. */
static void estimates_cover_the_error(void **state) {
    (void)state;
    scene_builder b;
    kiln_renderer *r = room(&b);
    picture reference = shoot(r, b.report, REFERENCE_SPP, 1u << 30, KILN_SAMPLER_SOBOL);
    for (int sampler = 0; sampler < 2; sampler++) {
        tally truth = {0}, estimate = {0};
        kiln_film_error errors[SEEDS];
        for (uint32_t i = 0; i < SEEDS; i++) {
            picture p = shoot(r, b.report, SPP, i, (kiln_sampler)sampler);
            errors[i] = p.error;
            tally_add(&truth, true_relmse(&p, &reference));
            tally_add(&estimate, p.error.relmse);
            picture_free(&p);
        }
        double covered = 0, bias = estimate.mean / truth.mean - 1;
        for (int i = 0; i < SEEDS; i++)
            covered += errors[i].relmse_low <= truth.mean && truth.mean <= errors[i].relmse_high;
        double least = 0.95 - 3.09 * sqrt(0.95 * 0.05 / SEEDS);
        if (fabs(bias) > 0.06) fail_msg("sampler %d: bias %g", sampler, bias);
        if (covered / SEEDS < least) fail_msg("sampler %d: %g covered, not %g", sampler, covered / SEEDS, least);
    }
    picture_free(&reference);
    kiln_renderer_destroy(r);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(estimates_cover_the_error)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
