/* render/path/estimate.h: how light that was found in two ways is counted once. Scalar kernels. */
#ifndef KILN_RENDER_PATH_ESTIMATE_H
#define KILN_RENDER_PATH_ESTIMATE_H

#include "kiln/render.h"
#include "render/light/light.h"

/* Weight of emission that a ray hit. pdf: of its direction by the BSDF, 0 from the camera or a perfectly specular bounce;
 * light_pdf: with which a light sample would have found it, 0 if none could.
 * NEE counts it only where no light sample could have found it: that is the specular rule. */
KERNEL float estimate_hit_weight(kiln_estimator estimator, float pdf, float light_pdf) {
    int always = (estimator == KILN_ESTIMATOR_BSDF) | (estimator == KILN_ESTIMATOR_DOUBLED);
    int never = estimator == KILN_ESTIMATOR_NAIVE;
    int alone = ((pdf == 0.0f) | (light_pdf == 0.0f) | always) & !never;
    float shared = estimator == KILN_ESTIMATOR_MIS ? mis_weight(pdf, light_pdf) : 0.0f;
    return alone ? 1.0f : shared;
}

/* What a ray is weighed by: the naive estimator, too, shows lights to the camera. */
KERNEL kiln_estimator estimate_hits_by(kiln_estimator estimator, uint32_t depth) {
    return estimator == KILN_ESTIMATOR_NAIVE && depth == 0 ? KILN_ESTIMATOR_NEE : estimator;
}

/* Weight of a light sample of density light_pdf, which the BSDF would have found with density pdf. Lights that nothing
 * can hit are found by light samples alone; with BSDF they are the only ones sampled. */
KERNEL float estimate_light_weight(kiln_estimator estimator, int parallel, float light_pdf, float pdf) {
    return parallel | (estimator != KILN_ESTIMATOR_MIS) ? 1.0f : mis_weight(light_pdf, pdf);
}

#endif
