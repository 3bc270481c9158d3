/* Prints nanoseconds per lane of BSDFs, for every row of bsdf_cases.c: loops over 1,024 lanes, loaded and compiled as the
 * stages' are. Both columns prepare the point first (shading_make), as every stage does. Nothing is tested.
 *
 *     cmake --build build/release --target bench_bsdf && build/release/tests/bench_bsdf [ROUGHNESS] */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/arena.h"
#include "render/path/lanes.h"
#include "tests/render/bsdf_cases.h"
#include "tests/render/statistics.h"

enum { BENCH_LANES = 1024, PASSES = 40, REPEATS = 9 };

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

typedef void kernel(batch *);
#define INSTANCES(kind)                                                                                                \
    static void __attribute__((noinline)) evaluate_##kind(batch *b) { evaluate(SHADING_MASK_##kind, b); }              \
    static void __attribute__((noinline)) sample_##kind(batch *b) { sample(SHADING_MASK_##kind, b); }
INSTANCES(DIFFUSE)
INSTANCES(GLOSSY)
INSTANCES(TRANSMISSIVE)
INSTANCES(LAYERED)

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

int main(int argc, char **argv) {
    float roughness = argc > 1 ? strtof(argv[1], NULL) : 0.3f;
    batch *b = aligned_array(1, sizeof *b);
    if (!b) return 1;
    printf("roughness %g, %d lanes, least of %d\n%-28s evaluate  sample  ns per lane\n", (double)roughness, BENCH_LANES,
           REPEATS, "material");
    for (size_t c = 0; c < bsdf_case_count; c++) {
        unsigned mask = bsdf_cases[c].mask;
        kernel *e = mask == SHADING_MASK_DIFFUSE        ? evaluate_DIFFUSE
                    : mask == SHADING_MASK_GLOSSY       ? evaluate_GLOSSY
                    : mask == SHADING_MASK_TRANSMISSIVE ? evaluate_TRANSMISSIVE
                                                        : evaluate_LAYERED;
        kernel *s = mask == SHADING_MASK_DIFFUSE        ? sample_DIFFUSE
                    : mask == SHADING_MASK_GLOSSY       ? sample_GLOSSY
                    : mask == SHADING_MASK_TRANSMISSIVE ? sample_TRANSMISSIVE
                                                        : sample_LAYERED;
        fill(b, &bsdf_cases[c], roughness);
        printf("%-28s %8.1f %7.1f\n", bsdf_cases[c].name, nanoseconds(e, b), nanoseconds(s, b));
    }
    free(b);
    return 0;
}
