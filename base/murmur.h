/* base/murmur.h: MurmurHash3_x86_32 (Austin Appleby, public domain), the hash that Cryptomatte names things by. */
#ifndef KILN_BASE_MURMUR_H
#define KILN_BASE_MURMUR_H

#include <stddef.h>
#include <stdint.h>

static inline uint32_t murmur_rotate(uint32_t x, int by) { return x << by | x >> (32 - by); }
static inline uint32_t murmur_scramble(uint32_t k) { return murmur_rotate(k * 0xcc9e2d51u, 15) * 0x1b873593u; }

/* Words are little-endian. */
static inline uint32_t murmur3_32(const void *data, size_t size, uint32_t seed) {
    const unsigned char *bytes = data;
    uint32_t h = seed, tail = 0;
    for (size_t i = 0; i < size / 4; i++, bytes += 4) {
        uint32_t k = bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
        h = murmur_rotate(h ^ murmur_scramble(k), 13) * 5 + 0xe6546b64u;
    }
    for (size_t i = size % 4; i-- > 0;) tail = tail << 8 | bytes[i];
    h ^= murmur_scramble(tail) ^ (uint32_t)size;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

#endif
