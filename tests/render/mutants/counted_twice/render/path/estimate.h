/* A mutant: NEE counts emission that the BSDF found although a light sample could have found it too. */
#ifndef KILN_MUTANT_COUNTED_TWICE
#define KILN_MUTANT_COUNTED_TWICE

#define estimate_hit_weight estimate_hit_weight_original
#include_next "render/path/estimate.h"
#undef estimate_hit_weight

KERNEL float estimate_hit_weight(kiln_estimator estimator, float pdf, float light_pdf) {
    return estimator == KILN_ESTIMATOR_NEE ? 1.0f : estimate_hit_weight_original(estimator, pdf, light_pdf);
}

#endif
