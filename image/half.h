/* image/half.h: the 16-bit floats of OpenEXR and TIFF (IEEE 754 binary16). */
#ifndef KILN_IMAGE_HALF_H
#define KILN_IMAGE_HALF_H

#include <stdint.h>
#include <string.h>

/* Exact, whether or not the thread flushes subnormal floats to zero. */
static inline float half_to_float(uint16_t half) {
    uint32_t exponent = half >> 10 & 31u, mantissa = half & 1023u, bits;
    float value = (float)mantissa * 0x1p-24f; /* a subnormal half is a normal float */
    memcpy(&bits, &value, sizeof bits);
    if (exponent) bits = (exponent == 31 ? 255u : exponent + 112u) << 23 | mantissa << 13; /* the bias: 15 and 127 */
    bits |= (uint32_t)(half & 0x8000u) << 16;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* To nearest, ties to even; beyond the largest half, ±65504; NaN stays NaN. */
static inline uint16_t float_to_half(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint16_t sign = (uint16_t)(bits >> 16 & 0x8000u);
    bits &= 0x7fffffffu;
    if (bits > 0x7f800000u) return sign | 0x7e00u;
    if (bits >= 0x477fe000u) return sign | 0x7bffu; /* 65504 */
    if (bits < 0x38800000u) {                       /* below 2^-14: a multiple of 2^-24, rounded by the addition */
        float magnitude, shifter = 0.5f;            /* whose unit in the last place is 2^-24 */
        memcpy(&magnitude, &bits, sizeof magnitude);
        magnitude += shifter;
        memcpy(&bits, &magnitude, sizeof bits);
        return (uint16_t)(sign | (bits - 0x3f000000u));
    }
    bits += 0xfffu + (bits >> 13 & 1u);
    return (uint16_t)(sign | ((bits - 0x38000000u) >> 13));
}

#endif
