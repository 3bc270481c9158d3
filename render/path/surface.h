/* render/path/surface.h: from a triangle and a ray to the point that is shaded. Scalar kernels. */
#ifndef KILN_RENDER_PATH_SURFACE_H
#define KILN_RENDER_PATH_SURFACE_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"

typedef struct triangle_hit { float u, v, t; } triangle_hit;

/* Möller and Trumbore 1997. The hit is recomputed from the triangle, so that it does not depend on Embree's instruction
 * set, and forced into the triangle; where the triangle is seen edge-on (no determinant) Embree's answer stands. */
KERNEL triangle_hit triangle_intersect(vec3 o, vec3 d, vec3 p0, vec3 e1, vec3 e2, triangle_hit embree) {
    vec3 pv = v3_cross(d, e2), tv = v3_sub(o, p0), qv = v3_cross(tv, e1);
    float det = v3_dot(e1, pv), inverse = 1.0f / det;
    float u = v3_dot(tv, pv) * inverse, v = v3_dot(d, qv) * inverse, t = v3_dot(e2, qv) * inverse;
    int good = (fabsf(u) < 2.0f) & (fabsf(v) < 2.0f) & (t > 0.0f) & (t < INFINITY);
    u = good ? u : embree.u;
    v = good ? v : embree.v;
    u = fm_clamp(u, 0.0f, 1.0f);
    v = fm_clamp(v, 0.0f, 1.0f - u);
    return (triangle_hit){u, v, good ? t : embree.t};
}

/* How far from the surface a ray must start so that it cannot meet it again: a bound on the rounding errors of a
 * barycentric point and of Embree's test of the ray against the triangle, along the geometric normal n.
 * 2⁻²⁰: sixteen roundings (Wächter and Binder 2019 and pbrt-v4, 6.8.5, count about seven each). Coordinates that play no
 * part, because the normal has no component along them, do not add to it. */
KERNEL float surface_reach(vec3 n, vec3 p0, vec3 e1, vec3 e2, float magnitude) {
    vec3 sum = v3_add(v3_abs(p0), v3_scale(v3_add(v3_abs(e1), v3_abs(e2)), 2.0f));
    return 0x1p-20f * (v3_dot(v3_abs(n), sum) + 4.0f * magnitude);
}

/* The interpolated normal, of unit length and on the side of the geometric one; that one itself if there is none. */
KERNEL vec3 surface_normal(vec3 n, vec3 geometric) {
    float length2 = v3_dot(n, n), side = v3_dot(n, geometric) < 0.0f ? -1.0f : 1.0f;
    int smooth = length2 > 1e-12f; /* of what were unit vectors */
    return v3_select(smooth, v3_scale(n, side / sqrtf(smooth ? length2 : 1.0f)), geometric);
}

/* A shading normal that faces away from wo has no meaning for a reflection: it is turned until wo just grazes the
 * surface. The least cosine, 1/100, keeps the frame's wo.z well above rounding. */
KERNEL vec3 surface_face(vec3 n, vec3 wo) {
    const float least = 0.01f;
    float c = v3_dot(n, wo);
    vec3 turned = v3_normalize(v3_madd(n, least - c, wo)); /* n − (n·wo) wo + least wo is at least `least` long */
    return v3_select(c < least, turned, n);
}

#endif
