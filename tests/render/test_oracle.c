/* The stages against a scalar driver over the same kernels: the same bits, sample by sample. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/context.h"
#include "render/path/path.h"
#include "tests/render/oracle.h"
#include "tests/render/scenes.h"

enum { SIDE = 24, SPP = 8 };

static bool same_bits(float a, float b) { return memcmp(&a, &b, sizeof a) == 0; }

/* Every sample of a small picture, in batches, against the oracle. */
static void compare(const path_context *c, const char *isa) {
    batch *b = aligned_array(1, sizeof *b);
    path_tracer *tracer = path_choose_tracer(isa, NULL);
    path_sample samples[BATCH_PATHS];
    uint32_t count = 0, lit = 0;
    if (!tracer) {
        print_message("this machine has not %s\n", isa);
        free(b);
        return;
    }
    for (uint32_t i = 0; i < SIDE * SIDE * SPP; i++) {
        samples[count++] = (path_sample){i / SPP % SIDE, i / SPP / SIDE, i % SPP, false};
        if (count < BATCH_PATHS && i + 1 < SIDE * SIDE * SPP) continue;
        tracer(c, samples, count, b);
        for (uint32_t k = 0; k < count; k++) {
            oracle_result o = oracle_trace(c, samples[k]);
            const float stages[7] = {b->out.r[k], b->out.g[k], b->out.b[k], b->out.beyond_r[k], b->out.beyond_g[k],
                                     b->out.beyond_b[k], b->out.alpha[k]};
            const float oracle[7] = {o.radiance.x, o.radiance.y, o.radiance.z, o.beyond.x, o.beyond.y, o.beyond.z, o.alpha};
            for (int v = 0; v < 7; v++)
                if (!same_bits(stages[v], oracle[v]))
                    fail_msg("%s, pixel (%u, %u), sample %u, value %d: %.9g from the stages, %.9g from the oracle", isa,
                             samples[k].x, samples[k].y, samples[k].n, v, (double)stages[v], (double)oracle[v]);
            lit += stages[0] > 0;
        }
        count = 0;
    }
    assert_true(lit > 0);
    free(b);
}

static void check(const kiln_render_options *options) {
    scene_builder b = builder_make();
    add_everything(&b);
    must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
    kiln_renderer *renderer;
    must(kiln_renderer_create(b.scene, &(kiln_renderer_options){.texture_filter = KILN_TEXTURES_MIP}, &renderer, b.report), b.report, "making a renderer");
    kiln_film *film;
    must(kiln_film_create(&(kiln_film_desc){.width = SIDE, .height = SIDE}, &film, b.report), b.report, "making a film");
    kiln_render_options o = *options;
    kiln_camera view = everything_camera();
    o.camera = &view;
    path_context c;
    assert_true(RUNS(renderer->world, TEXTURE_FILTERING)); /* cones are compared too */
    must(context_make(renderer, &o, film, &c, b.report), b.report, "making a context");
    const char *isas[] = {"v2", "v3", "v4"};
    for (int i = 0; i < 3; i++) compare(&c, isas[i]);
    kiln_film_destroy(film);
    kiln_renderer_destroy(renderer);
    builder_free(&b);
}

static void by_mis(void **state) { (void)state; check(&(kiln_render_options){.seed = 1}); }
static void by_nee(void **state) {
    (void)state;
    check(&(kiln_render_options){.seed = 2, .estimator = KILN_ESTIMATOR_NEE, .sampler = KILN_SAMPLER_INDEPENDENT,
                                 .roulette = {.kind = KILN_ROULETTE_FIXED, .p = 0.8}});
}
static void by_bsdf(void **state) {
    (void)state;
    check(&(kiln_render_options){.seed = 3, .estimator = KILN_ESTIMATOR_BSDF, .roulette = {.kind = KILN_ROULETTE_OFF}, .max_depth = 12});
}
static void by_the_wrong_ones(void **state) {
    (void)state;
    check(&(kiln_render_options){.seed = 6, .estimator = KILN_ESTIMATOR_NAIVE});
    check(&(kiln_render_options){.seed = 7, .estimator = KILN_ESTIMATOR_DOUBLED});
}
static void at_the_depth_limit(void **state) {
    (void)state;
    check(&(kiln_render_options){.seed = 4, .max_depth = 2, .light_sampling = KILN_LIGHTS_UNIFORM,
                                 .background = KILN_BACKGROUND_COLOR, .background_color = {0.1f, 0.2f, 0.3f}});
    check(&(kiln_render_options){.seed = 6, .max_depth = 3, .light_sampling = KILN_LIGHTS_POWER});
    check(&(kiln_render_options){.seed = 5, .max_depth = KILN_DEPTH_ZERO, .background = KILN_BACKGROUND_TRANSPARENT});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_mis), cmocka_unit_test(by_nee), cmocka_unit_test(by_bsdf),
                                       cmocka_unit_test(by_the_wrong_ones),
                                       cmocka_unit_test(at_the_depth_limit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
