/* The error that a film reports against the error that it has: one scene, many seeds, and a reference of far more
 * samples. Levels are stated; seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, SEEDS = 40, REFERENCE_SPP = 2048 };

/* What is rendered, and how: how far the estimate may be off on the average of all seeds, as a share of the root. */
typedef struct row {
    const char *name;
    void (*fill)(scene_builder *);
    float eye[3], at[3];
    kiln_sampler sampler;
    uint32_t spp, max_depth;
    double bias;
    double tails[2]; /* share of the seeds that must report a heavy tail: at least, at most */
} row;

static kiln_material lamp_of(float radiance) {
    kiln_material m = diffuse_material(0, 0, 0);
    for (int k = 0; k < 3; k++) m.emission.value[k] = radiance;
    return m;
}

/* A floor and a ball under a lamp and a little sky: soft shadows, indirect light. */
static void fill_room(scene_builder *b) {
    kiln_material floor = diffuse_material(0.7f, 0.6f, 0.5f), ball = diffuse_material(0.3f, 0.5f, 0.7f);
    kiln_material lamp = lamp_of(6);
    add_quad(b, add_material(b, &floor), (float[]){-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2});
    add_quad(b, add_material(b, &lamp), (float[]){-.6f, 2, -.6f, .6f, 2, -.6f, .6f, 2, .6f, -.6f, 2, .6f});
    add_sphere(b, add_material(b, &ball), (float[]){0, 0.5f, 0}, 0.5f, 16, 0);
    set_environment(b, 0, 0.1f, 0.1f, 0.1f);
}

/* A closed cell with a glass ball and a small lamp: rare bright paths. */
static void fill_cell(scene_builder *b) {
    kiln_material white = diffuse_material(.7f, .7f, .7f), lamp = lamp_of(60), glass = kiln_material_default();
    glass.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME;
    glass.metallic.value = glass.roughness.value = 0;
    glass.transmission.value = glass.thickness.value = 1;
    kiln_id wall = add_material(b, &white);
    add_quad(b, wall, (float[]){-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1});
    add_quad(b, wall, (float[]){-1, 2, -1, 1, 2, -1, 1, 2, 1, -1, 2, 1});
    add_quad(b, wall, (float[]){-1, 0, -1, 1, 0, -1, 1, 2, -1, -1, 2, -1});
    add_quad(b, wall, (float[]){-1, 0, 1, -1, 0, -1, -1, 2, -1, -1, 2, 1});
    add_quad(b, wall, (float[]){1, 0, -1, 1, 0, 1, 1, 2, 1, 1, 2, -1});
    add_quad(b, add_material(b, &lamp), (float[]){-.1f, 1.9f, -.1f, .1f, 1.9f, -.1f, .1f, 1.9f, .1f, -.1f, 1.9f, .1f});
    add_sphere(b, add_material(b, &glass), (float[]){.2f, .6f, .2f}, .4f, 48, 0);
}

static picture shoot(const kiln_renderer *r, kiln_report *report, const row *x, uint32_t spp, uint64_t seed) {
    kiln_camera view = camera_at(x->eye, x->at, 40);
    kiln_render_options o = {.camera = &view, .spp = spp, .seed = seed, .sampler = x->sampler,
                             .max_depth = x->max_depth};
    return render_with(r, &o, &(kiln_film_desc){.width = SIDE, .height = SIDE}, report);
}

/* As defined, where there is a surface. */
static double true_relmse(const picture *p, const picture *reference) {
    double sum = 0, n = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        double ref = (double)reference->rgb[i], d = (double)p->rgb[i] - ref;
        if (!p->film->hits[i / 3]) continue;
        sum += d * d / (ref * ref + 0.01);
        n++;
    }
    return sum / n;
}

/* Over the seeds the estimate has the mean of the true error, within what the row allows, and its interval, said to be
 * of 95 %, covers that mean in at least so many of the runs as a binomial law of 95 % would but in one case in a
 * thousand. */
static void check(const row *x, const kiln_renderer *r, kiln_report *report, const picture *reference) {
    tally truth = {0}, estimate = {0};
    kiln_film_error errors[SEEDS];
    double covered = 0, tails = 0, least = 0.95 - 3.09 * sqrt(0.95 * 0.05 / SEEDS);
    for (uint32_t i = 0; i < SEEDS; i++) {
        picture p = shoot(r, report, x, x->spp, i);
        errors[i] = p.error;
        tally_add(&truth, true_relmse(&p, reference));
        tally_add(&estimate, p.error.relmse);
        tails += p.error.heavy_tail;
        picture_free(&p);
    }
    for (int i = 0; i < SEEDS; i++)
        covered += errors[i].relmse_low <= truth.mean && truth.mean <= errors[i].relmse_high;
    double bias = sqrt(estimate.mean / truth.mean) - 1;
    if (fabs(bias) > x->bias) fail_msg("%s, %u spp: bias %g", x->name, x->spp, bias);
    if (covered / SEEDS < least) fail_msg("%s, %u spp: %g covered", x->name, x->spp, covered / SEEDS);
    if (tails < x->tails[0] * SEEDS || tails > x->tails[1] * SEEDS)
        fail_msg("%s, %u spp: %g heavy tails", x->name, x->spp, tails / SEEDS);
}

static void estimates_cover_the_error(void **state) {
    (void)state;
    static const row rows[][2] = {/* of one scene, and one reference */
        {{"room", fill_room, {0, 2, 4}, {0, 0.5f, 0}, KILN_SAMPLER_SOBOL, 16, 3, 0.05, {0, 0.05}},
         {"room", fill_room, {0, 2, 4}, {0, 0.5f, 0}, KILN_SAMPLER_INDEPENDENT, 16, 3, 0.05, {0, 0.05}}},
        {{"cell", fill_cell, {0, 1, 3.6f}, {0, 0.9f, 0}, KILN_SAMPLER_SOBOL, 16, 0, 0.25, {0.9, 1}},
         {"cell", fill_cell, {0, 1, 3.6f}, {0, 0.9f, 0}, KILN_SAMPLER_SOBOL, 64, 0, 0.15, {0, 1}}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const row *x = rows[k];
        scene_builder b = builder_make();
        kiln_renderer *r;
        x->fill(&b);
        must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
        must(kiln_renderer_create(b.scene, NULL, &r, b.report), b.report, "making a renderer");
        picture reference = shoot(r, b.report, x, REFERENCE_SPP, 1u << 30);
        for (int i = 0; i < 2; i++) check(&x[i], r, b.report, &reference);
        picture_free(&reference);
        kiln_renderer_destroy(r);
        builder_free(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(estimates_cover_the_error)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
