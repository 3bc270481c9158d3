/* A mutant: probabilities are one quantum too large. */
#ifndef KILN_MUTANT_PROBABILITY_TOO_LARGE_H
#define KILN_MUTANT_PROBABILITY_TOO_LARGE_H

#define distribution_probability distribution_probability_original
#include_next "render/light/distribution.h"
#undef distribution_probability

KERNEL float distribution_probability(const uint32_t *cdf, uint32_t index) {
    return distribution_probability_original(cdf, index) + 0x1p-24f;
}

#endif
