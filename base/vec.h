/* base/vec.h: 3-vectors of float, for kernels and for everything that is not too far from the origin. */
#ifndef KILN_BASE_VEC_H
#define KILN_BASE_VEC_H

#include <math.h>

#include "base/kernel.h"

typedef struct vec2 { float x, y; } vec2;
typedef struct vec3 { float x, y, z; } vec3;

KERNEL vec3 v3(float x, float y, float z) { return (vec3){x, y, z}; }
KERNEL vec3 v3_splat(float s) { return (vec3){s, s, s}; }
KERNEL vec3 v3_load(const float *p) { return (vec3){p[0], p[1], p[2]}; }
KERNEL void v3_store(float *p, vec3 v) { p[0] = v.x, p[1] = v.y, p[2] = v.z; }

KERNEL vec3 v3_add(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
KERNEL vec3 v3_sub(vec3 a, vec3 b) { return (vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
KERNEL vec3 v3_mul(vec3 a, vec3 b) { return (vec3){a.x * b.x, a.y * b.y, a.z * b.z}; }
KERNEL vec3 v3_scale(vec3 a, float s) { return (vec3){a.x * s, a.y * s, a.z * s}; }
KERNEL vec3 v3_neg(vec3 a) { return (vec3){-a.x, -a.y, -a.z}; }
/* a + s b */
KERNEL vec3 v3_madd(vec3 a, float s, vec3 b) { return (vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }
KERNEL float v3_dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
KERNEL vec3 v3_cross(vec3 a, vec3 b) {
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
KERNEL float v3_length(vec3 a) { return sqrtf(v3_dot(a, a)); }
/* The caller knows that a is not zero. */
KERNEL vec3 v3_normalize(vec3 a) { return v3_scale(a, 1.0f / sqrtf(v3_dot(a, a))); }
KERNEL float v3_max(vec3 a) {
    float m = a.x > a.y ? a.x : a.y;
    return m > a.z ? m : a.z;
}
/* m: 3 × 3, rows. */
KERNEL vec3 v3_transform(const float m[9], vec3 v) {
    return (vec3){m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                  m[6] * v.x + m[7] * v.y + m[8] * v.z};
}
KERNEL vec3 v3_lerp(vec3 a, vec3 b, float t) { return v3_madd(a, t, v3_sub(b, a)); }
KERNEL vec3 v3_select(int condition, vec3 a, vec3 b) {
    return (vec3){condition ? a.x : b.x, condition ? a.y : b.y, condition ? a.z : b.z};
}
KERNEL vec3 v3_abs(vec3 a) { return (vec3){fabsf(a.x), fabsf(a.y), fabsf(a.z)}; }

#endif
