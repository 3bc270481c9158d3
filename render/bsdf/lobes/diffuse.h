/* render/bsdf/lobes/diffuse.h: Lambert: f = ρ/π, sampled by the cosine, so that the multiplier is ρ.
 *
 * Local frame: z is the normal, wo.z > 0. `side` is +1 for reflection, −1 for diffuse transmission. */
#ifndef KILN_RENDER_BSDF_LOBES_DIFFUSE_H
#define KILN_RENDER_BSDF_LOBES_DIFFUSE_H

#include "render/sample/warp.h"

#define ONE_OVER_PI 0.318309886f

KERNEL vec3 diffuse_sample(vec2 u, float side) {
    vec3 wi = warp_cosine(u);
    return v3(wi.x, wi.y, side * wi.z);
}

/* cos θi / π on the lobe's side: also f · cos θi for ρ = 1. */
KERNEL float diffuse_pdf(vec3 wi, float side) {
    float c = side * wi.z;
    return c > 0.0f ? c * ONE_OVER_PI : 0.0f;
}

#endif
