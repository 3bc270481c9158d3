/* A mutant: MIS weights light samples as if nothing else could find the light. */
#ifndef KILN_MUTANT_UNWEIGHTED
#define KILN_MUTANT_UNWEIGHTED

#define estimate_light_weight estimate_light_weight_original
#include_next "render/path/estimate.h"
#undef estimate_light_weight

KERNEL float estimate_light_weight(kiln_estimator estimator, int parallel, float light_pdf, float pdf) {
    (void)estimator, (void)parallel, (void)light_pdf, (void)pdf;
    return 1.0f;
}

#endif
