/* render/bsdf/lobes/grazing.h: a density for light that microfacets reflect more than once.
 *
 * What compensation gives back (compensation.h) goes with cos θ (1 − E(cos θ)). The loss 1 − E of a nearly smooth surface
 * has its peak at cos θ ~ alpha and falls as 1/cos²θ above it, so the product is linear up to there and falls as 1/cos θ:
 *
 *     p = c cos θ/(cos²θ + k²), c = 1/(π log(1 + 1/k²)), k = 2.5 alpha
 *
 * and so is sampled by inversion. For k beyond 1 it is nearly the cosine's, as the lobe of a rough surface is. What is
 * given back is then at most some four times as much as its density says, for any alpha. Local frame: z is the normal, on
 * the side that light comes from. */
#ifndef KILN_RENDER_BSDF_LOBES_GRAZING_H
#define KILN_RENDER_BSDF_LOBES_GRAZING_H

#include "base/fmath.h"
#include "base/vec.h"

#define GRAZING_SPREAD 2.5f /* k over alpha */

/* k² and log2(1 + 1/k²). */
typedef struct grazing { float k2, octaves; } grazing_lobe;

/* alpha > 0 */
KERNEL grazing_lobe grazing_make(float alpha) {
    float k = GRAZING_SPREAD * alpha, k2 = k * k;
    return (grazing_lobe){k2, fm_log2(1.0f + 1.0f / k2)};
}

KERNEL vec3 grazing_sample(grazing_lobe g, vec2 u) {
    float z2 = fm_clamp(g.k2 * (fm_exp2(u.x * g.octaves) - 1.0f), 0.0f, 1.0f), r = sqrtf(1.0f - z2);
    fm_pair a = fm_sincos_2pi(u.y);
    return v3(r * a.cos, r * a.sin, sqrtf(z2));
}

/* c: cos θ ≥ 0 */
KERNEL float grazing_pdf(grazing_lobe g, float c) {
    return 0.459224111f / g.octaves * c / (c * c + g.k2); /* 1/(π log 2) */
}

#endif
