/* render/sample/dimensions.h: which random numbers a path uses, by purpose.
 *
 * A dimension belongs to a purpose at a depth, never to a running counter: switching an effect on or off cannot move
 * another effect's numbers. Pairs are stratified in two dimensions together. */
#ifndef KILN_RENDER_SAMPLE_DIMENSIONS_H
#define KILN_RENDER_SAMPLE_DIMENSIONS_H

#include <stdint.h>

/* Identifier, numbers it takes, what for. */
#define SAMPLE_PURPOSES(X)                                                                                             \
    X(PIXEL, 2, "place in the pixel's filter")                                                                         \
    X(LENS, 2, "place on the lens")                                                                                    \
    X(TIME, 1, "moment in the shutter")                                                                                \
    X(LIGHT, 2, "which light, and the place on it")                                                                    \
    X(LIGHT_FINE, 2, "the digits that the choice of a light leaves open; which shadow ray coverage stops")             \
    X(BSDF, 2, "direction of a lobe")                                                                                  \
    X(LOBE, 2, "which lobe; whether the path goes on")                                                                 \
    X(COVERAGE, 1, "whether a surface of partial coverage is hit")                                                     \
    X(WAVELENGTH, 1, "wavelength of a path that meets dispersion")                                                     \
    X(FLIGHT, 2, "how far a path goes in a medium that scatters; for which channel")

typedef enum sample_purpose {
#define SAMPLE_PURPOSE_ENUM(id, numbers, text) SAMPLE_##id,
    SAMPLE_PURPOSES(SAMPLE_PURPOSE_ENUM)
#undef SAMPLE_PURPOSE_ENUM
        SAMPLE_PURPOSE_COUNT
} sample_purpose;

/* The key of a purpose at a depth: what its scrambling is seeded with. In blocks of eight purposes, each with keys of its
 * own for all depths, so that a new purpose moves no other. */
static inline uint32_t sample_key(sample_purpose purpose, uint32_t depth) {
    return (uint32_t)purpose / 8u << 28 | (depth * 8u + (uint32_t)purpose % 8u);
}

#endif
