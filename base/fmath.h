/* base/fmath.h: elementary functions in single precision for loops that gcc must vectorise.
 *
 * No branch, call, table or integer division: selects, polynomials, sqrt and floor (one instruction each from SSE4.1
 * on). libm would leave such a loop scalar, and picks its variants by CPU; these give the same bits everywhere, as long
 * as the compiler neither contracts nor reassociates and the rounding mode is to nearest.
 *
 * Errors are in units of the last place of the exact result, the largest found by trying every float of the domain
 * (pairs: dense sets) against double precision; tests/base/test_fmath.c holds them. A NaN argument gives NaN unless
 * said otherwise. With FTZ/DAZ set, subnormal arguments count as 0 and subnormal results become 0.
 * The coefficients come from tools/fit_fmath.py. */
#ifndef KILN_BASE_FMATH_H
#define KILN_BASE_FMATH_H

#include <math.h>
#include <stdint.h>

#include "base/kernel.h"

#define FM_PI 3.14159274f

typedef struct fm_pair { float sin, cos; } fm_pair;

KERNEL uint32_t fm_bits(float x) { return ((union { float f; uint32_t u; }){.f = x}).u; }
KERNEL float fm_from_bits(uint32_t bits) { return ((union { uint32_t u; float f; }){.u = bits}).f; }

/* Both sides are evaluated: that is what keeps a loop free of branches. */
KERNEL float fm_select(int condition, float a, float b) { return condition ? a : b; }

/* b when either is NaN, as the instructions do; so fm_min(NaN, 1) is 1 and fm_min(1, NaN) is NaN. */
KERNEL float fm_min(float a, float b) { return a < b ? a : b; }
KERNEL float fm_max(float a, float b) { return a > b ? a : b; }
/* NaN stays NaN. low ≤ high. */
KERNEL float fm_clamp(float x, float low, float high) { return fm_min(high, fm_max(low, x)); }
/* Exactly a at t = 0 and b at t = 1. */
KERNEL float fm_lerp(float a, float b, float t) { return (1.0f - t) * a + t * b; }
/* Exact for every argument; keeps −0. */
KERNEL float fm_floor(float x) { return floorf(x); }

/* The next larger float of x in [0, ∞]; ∞ and NaN stay. */
KERNEL float fm_next_up(float x) { return x < INFINITY ? fm_from_bits((fm_bits(x) & 0x7fffffffu) + 1u) : x; }

/* 2^k for −126 ≤ k ≤ 127. */
KERNEL float fm_power_of_two(int32_t k) { return fm_from_bits((uint32_t)(k + 127) << 23); }

/* The nearest integer of |x| < 2²² is left in the low bits of x + FM_ROUND. */
#define FM_ROUND 0x1.8p23f

/* sin and cos of r + quadrant · π/2 from those of r: bit 0 of the quadrant swaps them, bit 1 negates the sine, bits 0
 * and 1 together the cosine. */
KERNEL fm_pair fm_turn_quadrant(float s, float c, uint32_t quadrant) {
    int odd = (quadrant & 1u) != 0u;
    float sine = odd ? c : s, cosine = odd ? s : c;
    return (fm_pair){fm_from_bits(fm_bits(sine) ^ (quadrant << 30 & 0x80000000u)),
                     fm_from_bits(fm_bits(cosine) ^ ((quadrant + 1u) << 30 & 0x80000000u))};
}

/* |x| ≤ 256: 2.5 ulp. Beyond, infinities included: NaN. sin(±0) is +0. */
KERNEL fm_pair fm_sincos(float x) {
    float shifted = x * 0.636619747f + FM_ROUND, k = shifted - FM_ROUND;
    /* Cody and Waite (1980): k has at most 8 bits and the first two parts of π/2 have 16, so those products are
     * exact. */
    float r = ((x - k * 1.57077026f) - k * 2.60630623e-05f) - k * 6.07710063e-11f, z = r * r;
    float s = r + r * (z * (-0.166666672f + z * (0.0083333794f + z * (-0.000198530644f + z * 2.83251075e-06f))));
    float c = 1.0f - 0.5f * z + z * z * (0.0416666456f + z * (-0.00138873095f + z * 2.44323273e-05f));
    fm_pair p = fm_turn_quadrant(s, c, fm_bits(shifted));
    int inside = fabsf(x) <= 256.0f;
    return (fm_pair){inside ? p.sin : NAN, inside ? p.cos : NAN};
}
KERNEL float fm_sin(float x) { return fm_sincos(x).sin; }
KERNEL float fm_cos(float x) { return fm_sincos(x).cos; }

/* sin and cos of 2 π u, for u in turns. |u| ≤ 2²⁰: 1.7 ulp; exact at multiples of a quarter. Beyond: NaN. */
KERNEL fm_pair fm_sincos_2pi(float u) {
    float shifted = 4.0f * u + FM_ROUND, r = u - 0.25f * (shifted - FM_ROUND), z = r * r; /* r is exact */
    float s = r * 6.28318548f +
              r * (-1.74845553e-07f + z * (-41.3417015f + z * (81.60495f + z * (-76.6695938f + z * 40.5285759f))));
    float c = 1.0f + z * (-19.7392082f + z * (64.9391479f + z * (-85.4245224f + z * 58.621048f)));
    fm_pair p = fm_turn_quadrant(s, c, fm_bits(shifted));
    int inside = fabsf(u) <= 0x1p20f;
    return (fm_pair){inside ? p.sin : NAN, inside ? p.cos : NAN};
}

/* p · 2^k, where shifted is k + FM_ROUND and −151 ≤ k ≤ 128. In two steps, because 2^k alone may not be a normal
 * number. */
KERNEL float fm_scale_by(float p, float shifted) {
    int32_t k = (int32_t)(fm_bits(shifted) - fm_bits(FM_ROUND)), half = k >> 1;
    return p * fm_power_of_two(half) * fm_power_of_two(k - half);
}

/* 1.2 ulp. +∞ from 128 on, +0 from −150 down. */
KERNEL float fm_exp2(float x) {
    float t = fm_clamp(x, -151.0f, 128.0f), shifted = t + FM_ROUND, f = t - (shifted - FM_ROUND);
    float p = 1.0f + f * (0.693147182f + f * (0.240226507f + f * (0.0555036366f + f * (0.00961791631f +
              f * (0.00133891345f + f * 0.000155253016f)))));
    return fm_scale_by(p, shifted);
}

/* 1.0 ulp. +∞ above 88.7228, +0 below −103.98. */
KERNEL float fm_exp(float x) {
    float t = fm_clamp(x, -104.5f, 89.0f), shifted = t * 1.44269502f + FM_ROUND, k = shifted - FM_ROUND;
    float r = (t - k * 0.693115234f) - k * 3.19461833e-05f; /* the first product is exact */
    float p = 1.0f + (r + r * r * (0.49999994f + r * (0.166665226f + r * (0.0416681916f + r * (0.00836852845f +
              r * 0.00138272753f)))));
    return fm_scale_by(p, shifted);
}

/* x = 2^k m with √½ ≤ m < √2, for finite x > 0. */
KERNEL float fm_split(float x, float *m) {
    float small = x < 0x1p-126f ? 23.0f : 0.0f, normal = x < 0x1p-126f ? x * 0x1p23f : x;
    uint32_t from_root = fm_bits(normal) - 0x3f3504f3u; /* the bits of √½ */
    *m = fm_from_bits((from_root & 0x007fffffu) + 0x3f3504f3u);
    return (float)((int32_t)from_root >> 23) - small;
}

/* The logarithm's value outside of 0 < x < ∞. */
KERNEL float fm_log_edges(float x, float value) {
    float v = x < INFINITY ? value : x; /* ∞ and NaN */
    v = x < 0.0f ? NAN : v;
    return x == 0.0f ? -INFINITY : v;
}

/* 0.9 ulp. −∞ at ±0, NaN below 0, +∞ at +∞. */
KERNEL float fm_log(float x) {
    float m, k = fm_split(x, &m), f = m - 1.0f;
    /* With s = f/(2 + f): log(1 + f) = 2 s + 2/3 s³ + … = f − (f²/2 − s (f²/2 + R)), whose large terms are exact. */
    float s = f / (2.0f + f), z = s * s, h = 0.5f * f * f;
    float R = z * (0.666666627f + z * (0.400009722f + z * (0.284987926f + z * 0.242790103f)));
    return fm_log_edges(x, k * 0.693115234f - ((h - (s * (h + R) + k * 3.19461833e-05f)) - f));
}

/* 1.5 ulp; powers of two are exact. The same edges as fm_log. */
KERNEL float fm_log2(float x) {
    float m, k = fm_split(x, &m), f = m - 1.0f;
    float s = f / (2.0f + f), z = s * s, h = 0.5f * f * f;
    float R = z * (0.666666627f + z * (0.400009722f + z * (0.284987926f + z * 0.242790103f)));
    float rest = s * (h + R) - h; /* log(1 + f) − f */
    return fm_log_edges(x, k + (f + (f * 0.442695051f + rest * 1.44269502f)));
}

/* x^y for x ≥ 0: 0.8 ulp, in double inside, for an error of log x is multiplied by y. As C's powf, 1 at y = 0 and at
 * x = 1; x = ±0 gives 0, 1 or +∞ by y's sign, x = +∞ the opposite. NaN below 0, and when either is NaN. */
KERNEL float fm_pow(float x, float y) {
    float m, k = fm_split(x, &m);
    double s = ((double)m - 1.0) / ((double)m + 1.0), z = s * s;
    double log2x = (double)k + s * (2.8853900817778495 + z * (0.96179669411419499 + z * (0.57707794212675967 +
                   z * (0.41220927569908428 + z * (0.31990476398987744 + z * 0.2829132210894118)))));
    /* Finite, so that 0 · log2x is 0, but beyond what the smallest y brings back. */
    log2x = x < INFINITY ? log2x : (double)x > 0.0 ? 0x1p200 : (double)x;
    log2x = x == 0.0f ? -0x1p200 : log2x;
    log2x = x < 0.0f ? (double)NAN : log2x;
    double t = (double)fm_clamp(y, -0x1p40f, 0x1p40f) * log2x; /* |y| = ∞ is no more than 2⁴⁰ */
    t = t > -151.0 ? t : t == t ? -151.0 : t;
    t = t < 128.0 ? t : t == t ? 128.0 : t;
    double rounded = (t + 0x1.8p52) - 0x1.8p52, f = t - rounded;
    double p = 1.0000000005541052 + f * (0.69314719963462146 + f * (0.24022647591154739 + f * (0.05550346499606678 +
               f * (0.0096186808932936171 + f * (0.0013394054425945807 + f * 0.00015247379657427575)))));
    return fm_scale_by((float)p, (float)rounded + FM_ROUND);
}

/* 1.6 ulp. C's conventions at zeros and infinities: atan2(±0, x) is ±0 for x ≥ +0 and ±π for x ≤ −0, atan2(±∞, +∞) is
 * ±π/4, and so on. */
KERNEL float fm_atan2(float y, float x) {
    float ax = fabsf(x), ay = fabsf(y), low = fm_min(ax, ay), high = fm_max(ax, ay);
    float t = low / high, z;
    t = low == high ? 1.0f : t; /* both infinite */
    t = high == 0.0f ? 0.0f : t;
    z = t * t;
    float a = t + t * (z * (-0.333332986f + z * (0.199985296f + z * (-0.142640412f + z * (0.109511688f +
              z * (-0.0840059593f + z * (0.0579106733f + z * (-0.0311328508f + z * (0.010891282f +
              z * -0.0017885702f)))))))));
    int steep = ay > ax, behind = (int32_t)fm_bits(x) < 0;
    float axis = steep ? 1.57079637f : behind ? FM_PI : 0.0f; /* the angle of the nearest one */
    float axis_low = steep ? -4.37113883e-08f : behind ? -8.74227766e-08f : 0.0f;
    a = axis + ((steep ^ behind ? -a : a) + axis_low);
    a = fm_from_bits(fm_bits(a) | (fm_bits(y) & 0x80000000u));
    a = x == x ? a : x;
    return y == y ? a : y;
}

/* 1.2 ulp. Arguments beyond ±1 count as ±1: a unit vector's component is often an ulp too long. */
KERNEL float fm_acos(float x) {
    float a = fm_clamp(fabsf(x), 0.0f, 1.0f);
    int outer = a > 0.5f; /* acos x = 2 asin √((1 − x)/2) */
    float z = outer ? 0.5f * (1.0f - a) : a * a, s = outer ? sqrtf(z) : a;
    float rest = s * (z * (0.166667521f + z * (0.0749530941f + z * (0.0454691537f + z * (0.0241847448f +
                 z * 0.0421583802f)))));
    float inner_value = 1.57079637f - (x + ((x < 0.0f ? -rest : rest) - -4.37113883e-08f));
    float outer_value = 2.0f * (s + rest);
    outer_value = x < 0.0f ? FM_PI - (outer_value - -8.74227766e-08f) : outer_value;
    return outer ? outer_value : inner_value;
}

#endif
