/* base/hash.h: integer hashes, the source of every random number. Pure functions: no state anywhere. */
#ifndef KILN_BASE_HASH_H
#define KILN_BASE_HASH_H

#include <stdint.h>

/* A bijection of 32 bits with low bias: lowbias32, found by Christopher Wellons' search (Hash Prospector, 2018). */
static inline uint32_t hash32(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/* One word from two or three; order matters. */
static inline uint32_t hash_pair(uint32_t a, uint32_t b) { return hash32(a + 0x9e3779b9u * hash32(b + 0x85ebca6bu)); }
static inline uint32_t hash_triple(uint32_t a, uint32_t b, uint32_t c) { return hash_pair(hash_pair(a, b), c); }

static inline uint32_t hash_u64(uint64_t x) { return hash_pair((uint32_t)x, (uint32_t)(x >> 32)); }

/* [0, 1): the upper 24 bits, so that the largest value is 1 − 2⁻²⁴. */
static inline float unit_float(uint32_t bits) { return (float)(int32_t)(bits >> 8) * 0x1p-24f; }

#endif
