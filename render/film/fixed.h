/* render/film/fixed.h: sums that do not depend on their order: 128-bit fixed point, quantum 2⁻⁶⁴.
 *
 * A sample must lie under 2³⁸ (2.7 · 10¹¹), so that 2²⁴ of them stay within 63 bits before the point. */
#ifndef KILN_RENDER_FILM_FIXED_H
#define KILN_RENDER_FILM_FIXED_H

#include <math.h>
#include <stdbool.h>

#include "base/fmath.h"

__extension__ typedef __int128 fixed;

#define FIXED_LARGEST 0x1p38f
#define FIXED_SAMPLES_MAX (1u << 24)

/* False for NaN and infinities too. */
static inline bool fixed_fits(float v) { return fabsf(v) < FIXED_LARGEST; }

/* Exact down to 2⁻⁶⁴, truncated below; v fits. */
static inline fixed fixed_from_float(float v) {
    uint32_t bits = fm_bits(v), exponent = bits >> 23 & 0xff;
    int shift = (int)exponent - 127 - 23 + 64; /* of the 24-bit mantissa */
    fixed mantissa = (fixed)((bits & 0x7fffffu) | 0x800000u);
    if (shift <= -24 || exponent == 0) return 0;
    fixed magnitude = shift >= 0 ? mantissa << shift : mantissa >> -shift;
    return bits >> 31 ? -magnitude : magnitude;
}

static inline double fixed_to_double(fixed sum) {
    return (double)(int64_t)(sum >> 64) + (double)(uint64_t)sum * 0x1p-64;
}

#endif
