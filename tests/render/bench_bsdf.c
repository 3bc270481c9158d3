/* Prints nanoseconds per lane of BSDFs: first lobe by lobe and layer by layer, each in a kernel of nothing else, then
 * every row of bsdf_cases.c in the kernel that the stages run for it. Loops over 1,024 lanes, loaded and compiled as the
 * stages' are; both columns prepare the point first (shading_make), as every stage does. Nothing is tested.
 *
 *     cmake --build build/release --target bench_bsdf && build/release/tests/bench_bsdf [ROUGHNESS [rows]] */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/arena.h"
#include "render/bsdf/lobes/phase.h"
#include "render/path/lanes.h"
#include "tests/render/bsdf_cases.h"
#include "tests/render/statistics.h"

enum { BENCH_LANES = 1024, PASSES = 20, REPEATS = 15 };

static void fill_surface(path_scratch *x, uint32_t i, const surface *s, float roughness) {
    x->base_r[i] = s->base.x, x->base_g[i] = s->base.y, x->base_b[i] = s->base.z;
    x->metallic[i] = s->metallic, x->roughness[i] = roughness, x->specular[i] = s->specular, x->f0[i] = s->f0;
    x->tint_r[i] = s->specular_color.x, x->tint_g[i] = s->specular_color.y, x->tint_b[i] = s->specular_color.z;
    x->transmission[i] = s->transmission, x->eta[i] = s->eta, x->thin[i] = s->thin;
    x->hue_r[i] = x->hue_g[i] = x->hue_b[i] = 1;
    x->near_layers[i] = s->near, x->far_layers[i] = s->far;
    x->anisotropy[i] = s->anisotropy, x->along_x[i] = 1, x->along_y[i] = x->along_z[i] = 0;
    x->film[i] = s->film, x->film_ior[i] = s->film_ior, x->film_thickness[i] = s->film_thickness;
    x->clearcoat[i] = s->clearcoat, x->clearcoat_roughness[i] = s->clearcoat_roughness;
    x->coat_x[i] = s->clearcoat_normal.x, x->coat_y[i] = s->clearcoat_normal.y, x->coat_z[i] = s->clearcoat_normal.z;
    x->sheen_r[i] = s->sheen.x, x->sheen_g[i] = s->sheen.y, x->sheen_b[i] = s->sheen.z;
    x->sheen_roughness[i] = s->sheen_roughness;
    x->pass[i] = s->diffuse_transmission;
    x->pass_r[i] = s->diffuse_transmission_color.x, x->pass_g[i] = s->diffuse_transmission_color.y;
    x->pass_b[i] = s->diffuse_transmission_color.z;
}

/* Seen, and asked, from all around; the light's direction lies in the connections' fields. */
static void fill(batch *b, const bsdf_case *row, float roughness) {
    subject s;
    subject_make(&s, row);
    path_state *state = batch_state(b);
    path_scratch *x = &b->scratch;
    stream random = {1, 0};
    for (uint32_t i = 0; i < BENCH_LANES; i++) {
        fill_surface(x, i, &s.surface, roughness);
        vec3 wo = direction_at((double)stream_between(&random, 0.05f, 1), (double)stream_next(&random));
        vec3 wi = stream_direction(&random);
        state->dx[i] = -wo.x, state->dy[i] = -wo.y, state->dz[i] = -wo.z;
        state->ox[i] = wi.x, state->oy[i] = wi.y, state->oz[i] = wi.z;
        x->nx[i] = x->ny[i] = x->gx[i] = x->gy[i] = 0, x->nz[i] = x->gz[i] = 1;
        x->u_lobe[i] = stream_next(&random);
        x->u_bsdf_x[i] = stream_next(&random), x->u_bsdf_y[i] = stream_next(&random);
    }
}

KERNEL void evaluate(unsigned mask, batch *b) {
    path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < BENCH_LANES; i++) {
        shading p = lane_shading(mask, s, x, i);
        bsdf_value v = bsdf_evaluate(mask, &p.bsdf, v3(s->ox[i], s->oy[i], s->oz[i]));
        s->tr[i] = v.value.x, s->tg[i] = v.value.y, s->tb[i] = v.value.z;
        s->pdf[i] = v.pdf;
    }
}

KERNEL void sample(unsigned mask, batch *b) {
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < BENCH_LANES; i++) {
        shading p = lane_shading(mask, s, x, i);
        bsdf_sampled r = bsdf_sample(mask, &p.bsdf, x->u_lobe[i], (vec2){x->u_bsdf_x[i], x->u_bsdf_y[i]});
        x->px[i] = r.wi.x, x->py[i] = r.wi.y, x->pz[i] = r.wi.z;
        s->tr[i] = r.multiplier.x, s->tg[i] = r.multiplier.y, s->tb[i] = r.multiplier.z;
        s->pdf[i] = r.pdf;
    }
}

/* Directions that a medium scatters to: value and density are one number. */
static void __attribute__((noinline)) evaluate_medium(batch *b) {
    path_state *s = batch_state(b);
    LANE_LOOP (uint32_t i = 0; i < BENCH_LANES; i++)
        s->pdf[i] = phase_value(v3(-s->dx[i], -s->dy[i], -s->dz[i]), v3(s->ox[i], s->oy[i], s->oz[i]), 0.5f);
}
static void __attribute__((noinline)) sample_medium(batch *b) {
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < BENCH_LANES; i++) {
        vec3 wo = {-s->dx[i], -s->dy[i], -s->dz[i]};
        vec3 wi = phase_sample(wo, 0.5f, (vec2){x->u_bsdf_x[i], x->u_bsdf_y[i]});
        x->px[i] = wi.x, x->py[i] = wi.y, x->pz[i] = wi.z;
        s->pdf[i] = phase_value(wo, wi, 0.5f);
    }
}

/* A layer's kernel, and the row that it is timed with. */
#define LAYER_KERNELS(X)                                                                                               \
    X(diffuse, "Lambert", SHADING_MASK_DIFFUSE, "lambert")                                                             \
    X(glossy, "metal, coat and base", SHADING_MASK_GLOSSY, "coat 1.5")                                                 \
    X(transmissive, "transmission", SHADING_MASK_TRANSMISSIVE, "glass 1.5")                                            \
    X(clearcoat, "clear coat on glossy", SHADING_MASK_GLOSSY | BSDF_CLEARCOAT, "clearcoat on plastic")                 \
    X(sheen, "sheen on glossy", SHADING_MASK_GLOSSY | BSDF_SHEEN, "narrow sheen on plastic")                           \
    X(anisotropic, "anisotropy of glossy", SHADING_MASK_GLOSSY | BSDF_ANISOTROPIC, "anisotropic metal")                \
    X(film, "film on glossy", SHADING_MASK_GLOSSY | BSDF_FILM, "film on plastic")                                      \
    X(translucent, "diffuse transmission", SHADING_MASK_TRANSMISSIVE | BSDF_TRANSLUCENT, "leaf")
/* The stages' further kernels. */
#define STAGE_KERNELS(X)                                                                                               \
    X(coated, "coated", SHADING_MASK_COATED, "clearcoat on plastic")                                                   \
    X(layered, "layered", SHADING_MASK_LAYERED, "clearcoat on glass")                                                  \
    X(filmed, "filmed", SHADING_MASK_FILMED, "all layers")

typedef void kernel(batch *);
#define INSTANCE(id, text, mask, row)                                                                                  \
    static void __attribute__((noinline)) evaluate_##id(batch *b) { evaluate(mask, b); }                               \
    static void __attribute__((noinline)) sample_##id(batch *b) { sample(mask, b); }
LAYER_KERNELS(INSTANCE)
STAGE_KERNELS(INSTANCE)

typedef struct instance { const char *text; unsigned mask; const char *row; kernel *evaluate, *sample; } instance;
#define ENTRY(id, text, mask, row) {text, mask, row, evaluate_##id, sample_##id},
static const instance instances[] = {LAYER_KERNELS(ENTRY) STAGE_KERNELS(ENTRY)};
enum { INSTANCES = sizeof instances / sizeof *instances };

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The least of some times: what others do to the machine only adds. */
static double nanoseconds(kernel *k, batch *b) {
    double least = 1e9;
    for (int r = 0; r < REPEATS; r++) {
        double start = now();
        for (int n = 0; n < PASSES; n++) k(b);
        double took = (now() - start) * 1e9 / ((double)PASSES * BENCH_LANES);
        least = took < least ? took : least;
    }
    return least;
}

static void print_row(const char *name, const instance *k, const bsdf_case *row, float roughness, batch *b) {
    fill(b, row, roughness);
    printf("%-28s %8.1f %7.1f\n", name, nanoseconds(k->evaluate, b), nanoseconds(k->sample, b));
}

int main(int argc, char **argv) {
    float roughness = argc > 1 ? strtof(argv[1], NULL) : 0.3f;
    batch *b = aligned_array(1, sizeof *b);
    if (!b) return 1;
    printf("roughness %g, %d lanes, least of %d\n%-28s evaluate  sample  ns per lane\n", (double)roughness, BENCH_LANES,
           REPEATS, "kernel");
    for (int k = 0; k < INSTANCES; k++)
        for (size_t c = 0; c < bsdf_case_count; c++)
            if (!strcmp(bsdf_cases[c].name, instances[k].row))
                print_row(instances[k].text, &instances[k], &bsdf_cases[c], roughness, b);
    print_row("medium", &(instance){.evaluate = evaluate_medium, .sample = sample_medium}, bsdf_cases, roughness, b);
    for (size_t c = 0; argc > 2 && c < bsdf_case_count; c++)
        for (int k = 0; k < INSTANCES; k++)
            if (instances[k].mask == bsdf_cases[c].mask)
                print_row(bsdf_cases[c].name, &instances[k], &bsdf_cases[c], roughness, b);
    free(b);
    return 0;
}
