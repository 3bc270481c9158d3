/* render/path/shading.h: what happens at a point: light arrives, and the path goes on. Scalar kernels. */
#ifndef KILN_RENDER_PATH_SHADING_H
#define KILN_RENDER_PATH_SHADING_H

#include "render/bsdf/bsdf.h"
#include "render/bsdf/kernels.h"
#include "render/path/estimate.h"
#include "render/path/surface.h"

/* A shading point: its frame, its BSDF, and where rays leave from. */
typedef struct shading {
    frame frame;
    bsdf bsdf;
    surface_sides sides;
    vec3 geometric; /* facing wo */
} shading;

KERNEL shading shading_make(unsigned mask, const surface *s, surface_sides sides, vec3 geometric, vec3 normal,
                            vec3 wo) {
    frame f = frame_make(normal);
    if (mask & BSDF_ANISOTROPIC) f = frame_select(s->anisotropy > 0.0f, frame_along(normal, s->along), f);
    surface local = *s;
    if (mask & BSDF_CLEARCOAT) local.clearcoat_normal = frame_to_local(&f, s->clearcoat_normal);
    return (shading){f, bsdf_make(mask, &local, frame_to_local(&f, wo)), sides, geometric};
}

/* A light sample must lie on the same side of the surface as of the bent one, or light would leak through. */
KERNEL int shading_side_agrees(unsigned mask, const shading *s, vec3 wi_local, vec3 wi) {
    float side = v3_dot(wi, s->sides.normal);
    int reflects = (wi_local.z > 0.0f) & (side > 0.0f);
    if (!(mask & BSDF_TRANSMISSIVE)) return reflects;
    return reflects | ((wi_local.z < 0.0f) & (side < 0.0f) & (v3_dot(wi, s->geometric) < 0.0f));
}

/* Where a ray starts. */
KERNEL vec3 shading_origin(unsigned mask, const shading *s, int crosses) {
    return mask & BSDF_TRANSMISSIVE ? v3_select(crosses, s->sides.below, s->sides.above) : s->sides.above;
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
    int comes = shading_side_agrees(mask, s, local, l->wi) & (density > 0.0f);
    vec3 sum = v3_mul(v3_mul(throughput, f.value), l->radiance);
    vec3 origin = shading_origin(mask, s, local.z < 0.0f), to = v3_sub(l->target, origin);
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

/* What the bent surface sends to the wrong side of the real one is mirrored there and goes on as from a mirror, without
 * a density: emission that it finds counts in full, for light samples leave such directions out. This is the tangent
 * facet of Schüßler et al. 2017, "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing", as a mirror: no
 * energy is lost and none is made. */
KERNEL shading_scattering shading_scatter(unsigned mask, const shading *s, vec3 throughput, float lobe, vec2 direction) {
    bsdf_sampled next = bsdf_sample(mask, &s->bsdf, lobe, direction);
    vec3 wi = v3_normalize(frame_to_world(&s->frame, next.wi));
    int crosses = next.crosses;
    float far = mask & BSDF_TRANSMISSIVE && crosses ? 1.0f : 0.0f, sign = 1.0f - 2.0f * far;
    /* How far wi lies on the wrong side, by the plane and, where it crosses, by the facet too: products, for branches
     * would keep loops scalar. */
    float off = fm_min(sign * v3_dot(wi, s->sides.normal), 0.0f), again = 0.0f;
    wi = v3_madd(wi, -2.0f * sign * off, s->sides.normal);
    if (mask & BSDF_TRANSMISSIVE) {
        again = far * fm_max(v3_dot(wi, s->geometric), 0.0f);
        wi = v3_madd(wi, -2.0f * again, s->geometric);
    }
    return (shading_scattering){shading_origin(mask, s, crosses), wi, v3_mul(throughput, next.multiplier),
                                off - again < 0.0f ? 0.0f : next.pdf, crosses};
}

#endif
