/* render/light/distribution.h: drawing from a discrete distribution, in order.
 *
 * Inversion keeps the stratification of the random numbers (an alias table would not); a guide table (Chen and Asau
 * 1974) makes it constant-time on average. Probabilities are whole multiples of 2⁻²⁴, the grain of unit_float, so what
 * is drawn and what is computed agree exactly. An outcome of no quantum is never drawn; its probability is 0. */
#ifndef KILN_RENDER_LIGHT_DISTRIBUTION_H
#define KILN_RENDER_LIGHT_DISTRIBUTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/kernel.h"

enum { DISTRIBUTION_QUANTA = 1 << 24 };

/* weights ≥ 0, finite, not all 0; count ≤ 2²³. cdf takes count + 1 values, from 0 to DISTRIBUTION_QUANTA; guide takes
 * count. Every positive weight gets a quantum at least. */
void distribution_build(const float *weights, uint32_t count, uint32_t *cdf, uint32_t *guide);

KERNEL float distribution_probability(const uint32_t *cdf, uint32_t index) {
    return (float)(int32_t)(cdf[index + 1] - cdf[index]) * 0x1p-24f;
}

/* Where distribution_pick starts to look. */
KERNEL const uint32_t *distribution_guide(const uint32_t *guide, uint32_t count, float u) {
    return guide + (((uint64_t)(uint32_t)(int32_t)(u * 0x1p24f) * count) >> 24);
}

/* The outcome for u in [0, 1); *rest is where u lies within it, in [0, 1): as stratified as u itself. fine in [0, 1) is
 * where in its quantum u lies, which its 24 bits do not say. */
KERNEL uint32_t distribution_pick(const uint32_t *cdf, const uint32_t *guide, uint32_t count, float u, float fine,
                                  float *rest) {
    uint32_t quantum = (uint32_t)(int32_t)(u * 0x1p24f);
    uint32_t index = *distribution_guide(guide, count, u);
    while (cdf[index + 1] <= quantum) index++;
    uint32_t size = cdf[index + 1] - cdf[index];
    float within = ((float)(int32_t)(quantum - cdf[index]) + fine) / (float)(int32_t)size;
    *rest = within < 0x1.fffffep-1f ? within : 0x1.fffffep-1f;
    return index;
}

#endif
