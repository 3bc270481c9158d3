/* render/world/spectrum.h: the colours of single wavelengths, for paths that meet dispersion.
 *
 * A path that enters a dispersive medium takes on one wavelength, drawn by the sum of what the three channels see of it,
 * and its throughput is multiplied by the colour of that wavelength over its density. So the weights' mean over all
 * wavelengths is white, none is negative, and their sum over the channels is nearly 3 everywhere. */
#ifndef KILN_RENDER_WORLD_SPECTRUM_H
#define KILN_RENDER_WORLD_SPECTRUM_H

#include <stddef.h>
#include <stdint.h>

#include "base/kernel.h"
#include "base/vec.h"

enum { SPECTRUM_STEPS = 256, SPECTRUM_FLOATS = 4 * (SPECTRUM_STEPS + 1) };

/* Rows of wavelength in nanometres and weights in the working space, at equal steps of the random number. to_working:
 * 3 × 3, from linear Rec.709. */
void spectrum_make(const float to_working[9], float table[SPECTRUM_FLOATS]);

typedef struct spectrum_line { float wavelength; vec3 weight; } spectrum_line;

/* u in [0, 1). Linear between the rows, so the mean over u is the mean of the rows' trapezoids: exactly white. */
KERNEL spectrum_line spectrum_draw(const float *table, float u) {
    float place = u * (float)SPECTRUM_STEPS;
    int32_t k = (int32_t)place;
    const float *a = table + 4 * (size_t)k, *b = a + 4;
    float t = place - (float)k;
    return (spectrum_line){a[0] + t * (b[0] - a[0]), v3_lerp(v3_load(a + 1), v3_load(b + 1), t)};
}

#endif
