/* A mutant: what a clear coat sends under the horizon of a bent base is lost. */
#ifndef KILN_MUTANT_HANGING_LOST_H
#define KILN_MUTANT_HANGING_LOST_H

#define bsdf_sample bsdf_sample_original
#include_next "render/bsdf/bsdf.h"
#undef bsdf_sample

KERNEL bsdf_sampled bsdf_sample(unsigned mask, const bsdf *b, float lobe, vec2 direction) {
    bsdf_sampled r = bsdf_sample_original(mask, b, lobe, direction);
    r.multiplier = v3_select((r.wi.z <= 0.0f) & !r.crosses, v3_splat(0.0f), r.multiplier);
    return r;
}

#endif
