/* render/path/medium.h: which media a point lies in: a stack of four, 16 bits each, the innermost lowest; 0: none. */
#ifndef KILN_RENDER_PATH_MEDIUM_H
#define KILN_RENDER_PATH_MEDIUM_H

#include <stdint.h>

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"

KERNEL uint64_t medium_enter(uint64_t media, uint32_t medium) { return media << 16 | medium; }

/* Takes the innermost occurrence out; a medium that the path never entered (an open mesh) changes nothing. */
KERNEL uint64_t medium_leave(uint64_t media, uint32_t medium) {
    uint64_t first = media >> 16;
    uint64_t second = (media >> 32 << 16) | (media & 0xffffu);
    uint64_t third = (media >> 48 << 32) | (media & 0xffffffffu);
    uint64_t fourth = media & 0xffffffffffffu;
    uint64_t r = media;
    r = (uint32_t)(media >> 48 & 0xffffu) == medium ? fourth : r;
    r = (uint32_t)(media >> 32 & 0xffffu) == medium ? third : r;
    r = (uint32_t)(media >> 16 & 0xffffu) == medium ? second : r;
    return (uint32_t)(media & 0xffffu) == medium ? first : r;
}

KERNEL uint64_t medium_cross(uint64_t media, uint32_t medium, int entering) {
    uint64_t in = medium_enter(media, medium), out = medium_leave(media, medium);
    return medium ? (entering ? in : out) : media;
}

/* What is left of light after a distance: exp(−σ distance), σ the three of a medium in the table. Over an infinite
 * distance nothing is taken: a ray that leaves the scene from inside of a medium has met an open mesh. */
KERNEL vec3 medium_transmittance(const float *absorption, uint32_t medium, float distance) {
    float d = distance < INFINITY ? -distance : 0.0f;
    int32_t k = 3 * (int32_t)medium; /* signed, and no pointer of its own: gathers want it so */
    return v3(fm_exp(absorption[k] * d), fm_exp(absorption[k + 1] * d), fm_exp(absorption[k + 2] * d));
}

#endif
