#include "render/light/distribution.h"

#include <math.h>

/* Every positive weight gets one quantum, and what it holds above a quantum's worth gets its share of the rest: each is
 * within a quantum of weight/sum, but for what the many under a quantum cost the others. Shares are differences of running
 * sums, so that roundings do not add up. */
static void quantise(const float *weights, uint32_t count, uint32_t *quanta) {
    double sum = 0, above = 0, before = 0;
    uint32_t positive = 0, placed = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum += (double)weights[i];
        positive += weights[i] > 0;
    }
    double worth = sum / DISTRIBUTION_QUANTA; /* not all weights are worth so much or less: count < DISTRIBUTION_QUANTA */
    for (uint32_t i = 0; i < count; i++) above += fmax((double)weights[i] - worth, 0);
    for (uint32_t i = 0; i < count; i++) {
        before += fmax((double)weights[i] - worth, 0);
        uint32_t share = (uint32_t)(before / above * (DISTRIBUTION_QUANTA - positive) + 0.5);
        quanta[i] = (weights[i] > 0) + share - placed;
        placed = share;
    }
}

void distribution_build(const float *weights, uint32_t count, uint32_t *cdf, uint32_t *guide) {
    quantise(weights, count, cdf + 1);
    cdf[0] = 0;
    for (uint32_t i = 0; i < count; i++) cdf[i + 1] += cdf[i];
    for (uint32_t slot = 0, index = 0; slot < count; slot++) {
        /* The first quantum that falls into the slot: ceil(slot 2²⁴ / count). */
        uint32_t first = (uint32_t)((((uint64_t)slot << 24) + count - 1) / count);
        while (cdf[index + 1] <= first) index++;
        guide[slot] = index;
    }
}
