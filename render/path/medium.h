/* render/path/medium.h: which media a point lies in: a stack of four, 16 bits each; 0: none. Scalar kernels.
 *
 * Media are numbered by rank (render/world/media.c), and the stack is kept in that order, the highest lowest: that is
 * the one which is there, whatever others overlap it (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced
 * Images"). A medium may be in the stack more than once, for copies share materials. */
#ifndef KILN_RENDER_PATH_MEDIUM_H
#define KILN_RENDER_PATH_MEDIUM_H

#include <stdint.h>

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"
#include "render/world/world.h"

/* The medium that is there. */
KERNEL uint32_t medium_top(uint64_t media) { return (uint32_t)(media & 0xffffu); }

/* A fifth one is too many: the lowest rank is forgotten. */
KERNEL uint64_t medium_enter(uint64_t media, uint32_t medium) {
    unsigned above = 0;
    for (unsigned k = 0; k < 64; k += 16) above += (media >> k & 0xffffu) > medium ? 16u : 0u;
    if (above == 64) return media;
    uint64_t higher = media & (((uint64_t)1 << above) - 1);
    return (media ^ higher) << 16 | (uint64_t)medium << above | higher;
}

/* Takes one occurrence out; a medium that the path never entered (an open mesh) changes nothing. */
KERNEL uint64_t medium_leave(uint64_t media, uint32_t medium) {
    for (unsigned k = 0; k < 64; k += 16) {
        if ((media >> k & 0xffffu) != medium) continue;
        uint64_t higher = media & (((uint64_t)1 << k) - 1);
        return k == 48 ? higher : media >> (k + 16) << k | higher;
    }
    return media;
}

/* The stack on the other side of a boundary of the medium; 0: not a boundary. */
KERNEL uint64_t medium_cross(uint64_t media, uint32_t medium, int entering) {
    return !medium ? media : entering ? medium_enter(media, medium) : medium_leave(media, medium);
}

/* What is left of light after a distance: exp(−σ distance), σ the three of a medium in the table. Over an infinite
 * distance nothing is taken: a ray that leaves the scene from inside of a medium has met an open mesh. */
KERNEL vec3 medium_transmittance(const float *extinction, uint32_t medium, float distance) {
    float d = distance < INFINITY ? -distance : 0.0f;
    int32_t k = 3 * (int32_t)medium; /* signed, and no pointer of its own: gathers want it so */
    return v3(fm_exp(extinction[k] * d), fm_exp(extinction[k + 1] * d), fm_exp(extinction[k + 2] * d));
}

#define WAVELENGTH_D 587.6f /* nanometres: of helium's d line, where the index is the material's */

/* KHR_materials_dispersion: n(λ) = n_d + (n_d − 1)/V (523655/λ² − 1.5168) ≥ 1, λ in nanometres: Cauchy's first terms. */
KERNEL float medium_ior(const world_medium *m, float wavelength) {
    float n = m->ior + m->spread * (523655.0f / (wavelength * wavelength) - 1.5168f);
    return fm_clamp(n, 1.0f, WORLD_IOR_MAX);
}

/* What a path that travels in `near` meets at a surface that bounds `medium` and leads to the stack `beyond`. */
typedef struct medium_boundary {
    float eta;  /* n of the far side over n of the near one */
    int hidden; /* the same medium is there on both sides: nothing reflects, nothing bends */
} medium_boundary;

KERNEL medium_boundary medium_boundary_at(const world_medium *table, uint32_t medium, uint64_t media, uint64_t beyond,
                                          int entering, float wavelength) {
    uint32_t near = medium_top(media), far = medium_top(beyond);
    /* Left, but never entered: the mesh is open. The medium is taken to have been there, unless a higher one is. */
    if (media == beyond && !entering && medium > near) near = medium;
    return (medium_boundary){medium_ior(&table[far], wavelength) / medium_ior(&table[near], wavelength), near == far};
}

/* Is a boundary of `medium` hidden from who looks at its front, or at its back, out of the stack `media`? */
KERNEL int medium_hides(const world_medium *table, uint32_t medium, uint64_t media, int front) {
    uint64_t beyond = medium_cross(media, medium, front);
    return medium != 0 && medium_boundary_at(table, medium, media, beyond, front, WAVELENGTH_D).hidden;
}

#endif
