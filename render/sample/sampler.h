/* render/sample/sampler.h: random numbers of sample n of a pixel, as pure functions of (seed, pixel, n, purpose).
 *
 * Sobol' points in pairs, each pair of its own shuffled and Owen-scrambled sequence ("padding"): Burley 2020,
 * "Practical Hash-based Owen Scrambling", JCGT 9(4). Samples fall to KILN_REPLICATES sequences in turn, scrambled
 * independently, because the halves of one sequence tell nothing about its error. */
#ifndef KILN_RENDER_SAMPLE_SAMPLER_H
#define KILN_RENDER_SAMPLE_SAMPLER_H

#include "base/hash.h"
#include "base/vec.h"
#include "render/sample/dimensions.h"

/* Two sums suffice for the variance of a picture, because it pools all pixels; more would cost stratification
 * (docs/estimator.md has the measurement). */
enum { KILN_REPLICATES_LOG2 = 1, KILN_REPLICATES = 1 << KILN_REPLICATES_LOG2 };

/* What all numbers of one sample share: its place in the sequence of its replicate, and what scrambles that. */
typedef struct sample_point {
    uint32_t index; /* in its replicate's sequence */
    uint32_t seed;  /* of (film seed, pixel, replicate) */
} sample_point;

static inline sample_point sample_point_make(uint32_t seed, uint32_t pixel, uint32_t sample) {
    uint32_t replicate = sample & (KILN_REPLICATES - 1);
    return (sample_point){sample >> KILN_REPLICATES_LOG2, hash_triple(seed, pixel, replicate)};
}

static inline uint32_t reverse_bits(uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

/* A random permutation in which every bit depends on the bits below it alone: an Owen scramble of the reversed
 * number. Constants: Vegdahl 2021, "Building a Better LK Hash". */
static inline uint32_t owen_hash(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* The second Sobol' dimension of index, bit-reversed: its generator is the Pascal triangle modulo 2, a Kronecker power
 * of [1 1; 0 1], applied one factor at a time. */
static inline uint32_t sobol_second_reversed(uint32_t index) {
    uint32_t x = index;
    x ^= (x & 0xaaaaaaaau) >> 1;
    x ^= (x & 0xccccccccu) >> 2;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xffff0000u) >> 16;
    return x;
}

static inline vec2 sample_sobol(sample_point p, uint32_t key) {
    uint32_t seed = hash_pair(p.seed, key);
    uint32_t shuffled = reverse_bits(owen_hash(reverse_bits(p.index), seed));
    uint32_t x = reverse_bits(owen_hash(shuffled, hash32(seed ^ 0x68bc21ebu)));
    uint32_t y = reverse_bits(owen_hash(sobol_second_reversed(shuffled), hash32(seed ^ 0x02e5be93u)));
    return (vec2){unit_float(x), unit_float(y)};
}

static inline vec2 sample_independent(sample_point p, uint32_t key) {
    uint32_t x = hash_triple(p.seed, p.index, key);
    return (vec2){unit_float(x), unit_float(hash32(x + 0x9e3779b9u))};
}

static inline vec2 sample_keyed(int independent, sample_point p, uint32_t key) {
    return independent ? sample_independent(p, key) : sample_sobol(p, key);
}
/* The numbers of a purpose at a depth; independent is a constant at the call. */
static inline vec2 sample_pair(int independent, sample_point p, sample_purpose purpose, uint32_t depth) {
    return sample_keyed(independent, p, sample_key(purpose, depth));
}

#endif
