/* A mutant: what a bent surface sends under the real one is lost, as it was before it was mirrored. */
#ifndef KILN_MUTANT_DROPPED_BELOW_H
#define KILN_MUTANT_DROPPED_BELOW_H

#define shading_scatter shading_scatter_original
#include_next "render/path/shading.h"
#undef shading_scatter

KERNEL shading_scattering shading_scatter(unsigned mask, const shading *s, vec3 throughput, float lobe, vec2 direction) {
    shading_scattering r = shading_scatter_original(mask, s, throughput, lobe, direction);
    r.throughput = v3_scale(r.throughput, r.pdf > 0.0f ? 1.0f : 0.0f); /* in a scene without delta lobes */
    return r;
}

#endif
