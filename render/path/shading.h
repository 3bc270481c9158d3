/* render/path/shading.h: what happens at a point: light arrives, and the path goes on. Scalar kernels. */
#ifndef KILN_RENDER_PATH_SHADING_H
#define KILN_RENDER_PATH_SHADING_H

#include "render/bsdf/bsdf.h"
#include "render/path/estimate.h"

/* The terms of the BSDF that a kind of material has. */
#define SHADING_MASK_DIFFUSE 0u
#define SHADING_MASK_GLOSSY ((unsigned)BSDF_GLOSSY)
#define SHADING_MASK_TRANSMISSIVE ((unsigned)(BSDF_GLOSSY | BSDF_TRANSMISSIVE))
#define SHADING_MASK_LAYERED ((unsigned)(BSDF_GLOSSY | BSDF_TRANSMISSIVE | BSDF_LAYERED))

/* A shading point: its frame, its BSDF, and where rays leave from. */
typedef struct shading {
    frame frame;
    bsdf bsdf;
    vec3 position, geometric;
    float reach;
} shading;

KERNEL shading shading_make(unsigned mask, const surface *s, vec3 position, vec3 geometric, vec3 normal, float reach,
                            vec3 wo) {
    frame f = mask & BSDF_LAYERED ? frame_along(normal, s->along) : frame_make(normal);
    surface local = *s;
    if (mask & BSDF_LAYERED) local.clearcoat_normal = frame_to_local(&f, s->clearcoat_normal);
    return (shading){f, bsdf_make(mask, &local, frame_to_local(&f, wo)), position, geometric, reach};
}

/* A direction must lie on the same side of the real surface as of the shaded one, or light would leak through. */
KERNEL int shading_side_agrees(const shading *s, vec3 wi_local, vec3 wi) {
    return (wi_local.z > 0.0f) == (v3_dot(wi, s->geometric) > 0.0f);
}

/* Where a ray along wi starts. */
KERNEL vec3 shading_leave(const shading *s, vec3 wi) {
    return v3_madd(s->position, v3_dot(wi, s->geometric) > 0.0f ? s->reach : -s->reach, s->geometric);
}

/* What a light sample would add, and the ray that decides whether it does. */
typedef struct shading_connection {
    vec3 contribution;
    vec3 origin, direction;
    float far;
} shading_connection;

/* throughput · f cos · radiance · weight / density. density: of the direction, times the probability of the light. */
KERNEL shading_connection shading_connect(unsigned mask, const shading *s, kiln_estimator estimator, vec3 throughput,
                                          const light_sampled *l, float density) {
    vec3 local = frame_to_local(&s->frame, l->wi);
    bsdf_value f = bsdf_evaluate(mask, &s->bsdf, local);
    float weight = estimate_light_weight(estimator, l->parallel, density, f.pdf);
    int comes = shading_side_agrees(s, local, l->wi) & (density > 0.0f);
    vec3 sum = v3_mul(v3_mul(throughput, f.value), l->radiance);
    vec3 origin = shading_leave(s, l->wi), to = v3_sub(l->target, origin);
    int placed = l->distance < INFINITY;
    float length = sqrtf(v3_dot(to, to));
    return (shading_connection){v3_scale(sum, comes ? weight / density : 0.0f), origin,
                                v3_select(placed, v3_scale(to, 1.0f / fm_max(length, 1e-30f)), l->wi),
                                placed ? length : INFINITY};
}

/* The next ray of the path, before roulette. */
typedef struct shading_scattering {
    vec3 origin, direction, throughput;
    float pdf;
    int crosses; /* it lies on the far side */
} shading_scattering;

KERNEL shading_scattering shading_scatter(unsigned mask, const shading *s, vec3 throughput, float lobe, vec2 direction) {
    bsdf_sampled next = bsdf_sample(mask, &s->bsdf, lobe, direction);
    vec3 wi = v3_normalize(frame_to_world(&s->frame, next.wi));
    float goes_on = shading_side_agrees(s, next.wi, wi) ? 1.0f : 0.0f;
    return (shading_scattering){shading_leave(s, wi), wi, v3_scale(v3_mul(throughput, next.multiplier), goes_on),
                                next.pdf, next.wi.z < 0.0f};
}

#endif
