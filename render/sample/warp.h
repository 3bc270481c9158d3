/* render/sample/warp.h: from the unit square to disks, hemispheres, triangles. */
#ifndef KILN_RENDER_SAMPLE_WARP_H
#define KILN_RENDER_SAMPLE_WARP_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"

/* Uniform on the unit disk, polar: radius sqrt(u.x), angle 2 π u.y. */
KERNEL vec2 warp_disk(vec2 u) {
    float r = sqrtf(u.x);
    fm_pair a = fm_sincos_2pi(u.y);
    return (vec2){r * a.cos, r * a.sin};
}

/* Density cos θ / π on the upper hemisphere (Malley: a disk, lifted). */
KERNEL vec3 warp_cosine(vec2 u) {
    vec2 d = warp_disk(u);
    float z2 = 1.0f - u.x; /* > 0, because u.x < 1 */
    return v3(d.x, d.y, sqrtf(z2));
}

/* Uniform in the cone cos θ ≥ cos_max around z; 1 − cos_max given, for it is small for a sun. */
KERNEL vec3 warp_cone(vec2 u, float one_minus_cos_max) {
    float h = u.x * one_minus_cos_max, r2 = h * (2.0f - h);
    float r = sqrtf(r2 > 0.0f ? r2 : 0.0f);
    fm_pair a = fm_sincos_2pi(u.y);
    return v3(r * a.cos, r * a.sin, 1.0f - h);
}

/* Uniform on a triangle: weights of its second and third vertex. */
KERNEL vec2 warp_triangle(vec2 u) {
    float s = sqrtf(u.x);
    return (vec2){s * (1.0f - u.y), s * u.y};
}

#endif
