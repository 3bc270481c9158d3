#include "render/light/distribution.h"

/* Rounds weight/sum to quanta; what rounding leaves over or takes too much is put on, or taken from, the largest. */
static void quantise(const float *weights, uint32_t count, uint32_t *quanta) {
    double sum = 0;
    uint32_t largest = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum += (double)weights[i];
        if (weights[i] > weights[largest]) largest = i;
    }
    int64_t left = DISTRIBUTION_QUANTA;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t q = (uint32_t)((double)weights[i] / sum * DISTRIBUTION_QUANTA + 0.5);
        if (weights[i] > 0 && q == 0) q = 1;
        quanta[i] = q;
        left -= q;
    }
    /* Many outcomes under a quantum may have taken more than the largest has: then the large ones pay in turn. */
    while (left < 0 && -left >= (int64_t)quanta[largest]) {
        for (uint32_t i = 0; i < count && left < 0; i++)
            if (quanta[i] > 1) {
                quanta[i]--;
                left++;
            }
    }
    quanta[largest] = (uint32_t)((int64_t)quanta[largest] + left);
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
