/* render/path/surface.h: from a triangle and a ray to the point that is shaded. Scalar kernels. */
#ifndef KILN_RENDER_PATH_SURFACE_H
#define KILN_RENDER_PATH_SURFACE_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"
#include "render/bsdf/frame.h"

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
 * part, because the normal has no component along them, do not add to it.
 *
 * The plane of a needle leans by what the products of its normal lose to cancellation: at the far end it is off by that
 * times the length, over the area. More than its own height is not asked for, or a ray would leave from somewhere else. */
KERNEL float surface_reach(vec3 n, vec3 p0, vec3 e1, vec3 e2, float magnitude) {
    vec3 a = v3_abs(e1), b = v3_abs(e2), edges = v3_add(a, b);
    vec3 sum = v3_add(v3_abs(p0), v3_scale(edges, 2.0f));
    float reach = 0x1p-20f * (v3_dot(v3_abs(n), sum) + 4.0f * magnitude);
    vec3 products = v3(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
    float twice = fabsf(v3_dot(v3_cross(e1, e2), n)), length2 = fm_max(v3_dot(edges, edges), 1e-37f);
    float lean = 0x1p-22f * v3_dot(products, edges) / fm_max(twice, 1e-37f), height = twice / sqrtf(length2);
    return fm_max(reach, lean < height ? lean : height);
}

/* The interpolated normal, of unit length and on the side of the geometric one; that one itself if there is none, or if
 * the corners' normals, whose squared lengths sum to corners2, cancel. A copy that is stretched makes normals short. */
KERNEL vec3 surface_normal(vec3 n, float corners2, vec3 geometric) {
    float length2 = v3_dot(n, n), side = v3_dot(n, geometric) < 0.0f ? -1.0f : 1.0f;
    int smooth = length2 > 1e-12f * corners2;
    return v3_select(smooth, v3_scale(n, side / sqrtf(smooth ? length2 : 1.0f)), geometric);
}

/* A triangle in render space, and what Embree and its copy say. */
typedef struct surface_triangle {
    vec3 p0, p1, p2;
    vec3 n0, n1, n2; /* 0: flat */
    vec2 uv0, uv1, uv2;
    float side;      /* −1: its copy mirrors */
    float magnitude; /* of its copy */
    triangle_hit embree;
} surface_triangle;

typedef struct surface_point {
    triangle_hit hit;
    vec3 position, geometric, shading; /* normals on the side that the ray came from */
    float reach, area, front;          /* front: 1, from behind: 0 */
    vec2 uv;
} surface_point;

KERNEL surface_point surface_at(vec3 o, vec3 d, const surface_triangle *s) {
    vec3 e1 = v3_sub(s->p1, s->p0), e2 = v3_sub(s->p2, s->p0);
    triangle_hit h = triangle_intersect(o, d, s->p0, e1, e2, s->embree);
    float b0 = 1.0f - h.u - h.v;
    vec3 n = v3_scale(v3_cross(e1, e2), s->side);
    float twice = sqrtf(v3_dot(n, n));
    n = v3_scale(n, 1.0f / fm_max(twice, 1e-37f)); /* Embree reports no hit on a triangle without area */
    float front = v3_dot(n, d) < 0.0f ? 1.0f : 0.0f;
    n = v3_scale(n, front > 0.5f ? 1.0f : -1.0f);
    vec3 smooth = v3_madd(v3_madd(v3_scale(s->n0, b0), h.u, s->n1), h.v, s->n2);
    float corners2 = v3_dot(s->n0, s->n0) + v3_dot(s->n1, s->n1) + v3_dot(s->n2, s->n2);
    return (surface_point){.hit = h,
                           .position = v3_madd(v3_madd(s->p0, h.u, e1), h.v, e2),
                           .geometric = n,
                           .shading = surface_normal(smooth, corners2, n),
                           .reach = surface_reach(n, s->p0, e1, e2, s->magnitude),
                           .area = 0.5f * twice,
                           .front = front,
                           .uv = {b0 * s->uv0.x + h.u * s->uv1.x + h.v * s->uv2.x,
                                  b0 * s->uv0.y + h.u * s->uv1.y + h.v * s->uv2.y}};
}

/* Where rays leave a point from, and which plane parts what leaves on wo's side from what crosses. */
typedef struct surface_sides {
    vec3 normal;       /* of that plane, facing wo */
    vec3 above, below; /* origins on wo's side and on the far side */
} surface_sides;

KERNEL surface_sides surface_flat_sides(const surface_point *p) {
    return (surface_sides){p->geometric, v3_madd(p->position, p->reach, p->geometric),
                           v3_madd(p->position, -p->reach, p->geometric)};
}

/* A shading normal that faces away from wo has no meaning for a reflection: it is turned until wo just grazes the
 * surface. The least cosine, 1/100, keeps the frame's wo.z well above rounding. */
KERNEL vec3 surface_face(vec3 n, vec3 wo) {
    const float least = 0.01f;
    float c = v3_dot(n, wo);
    vec3 turned = v3_normalize(v3_madd(n, least - c, wo)); /* n − (n·wo) wo + least wo is at least `least` long */
    return v3_select(c < least, turned, n);
}

/* How far a corner's tangent plane lies above a point of the triangle, along the corner's normal, times the corner's
 * weight. Normals that lean more than 53° from the facet are those of an edge that was smoothed away (a cube's corners
 * lean 55°), not of a surface that the facet stands for. */
KERNEL vec3 surface_corner_lift(vec3 position, vec3 corner, vec3 n, float weight, vec3 geometric) {
    float length2 = v3_dot(n, n), slope = v3_dot(n, geometric), depth = v3_dot(v3_sub(corner, position), n);
    depth = slope < 0.0f ? -depth : depth;
    int rises = (depth > 0.0f) & (slope * slope > 0.36f * length2);
    float along = weight * depth / fm_max(length2, 1e-37f);
    return v3_scale(n, rises ? slope < 0.0f ? -along : along : 0.0f);
}

/* Hanika 2021, "Hacking the Shadow Terminator" (Ray Tracing Gems II, chapter 4): what leaves a bulging facet starts at
 * the smooth surface that it stands for, so that neither its own horizon nor its neighbours' edges cut the light that the
 * smooth surface would get; what its shape itself hides, the ray finds out. Rays that cross start at the facet. Where the
 * smooth surface is not above the facet, the facet's plane is the one that counts. */
KERNEL surface_sides surface_smooth_sides(const surface_point *p, const surface_triangle *t, vec3 wo) {
    vec3 x = p->position, g = p->geometric;
    float b0 = 1.0f - p->hit.u - p->hit.v;
    vec3 lift = surface_corner_lift(x, t->p0, t->n0, b0, g);
    lift = v3_add(lift, surface_corner_lift(x, t->p1, t->n1, p->hit.u, g));
    lift = v3_add(lift, surface_corner_lift(x, t->p2, t->n2, p->hit.v, g));
    int lifted = v3_dot(lift, g) > p->reach;
    surface_sides flat = surface_flat_sides(p);
    return (surface_sides){v3_select(lifted, surface_face(p->shading, wo), g),
                           v3_add(flat.above, v3_select(lifted, lift, v3_splat(0.0f))), flat.below};
}

/* The tangent-space normal of a map in render space: x T + y B + z N, N of unit length, T made orthogonal to it,
 * B = w N × T (glTF 2.0, 3.7.2.1). x = y = 0 stands for no map. Seen from behind, the bent surface is turned over as a
 * whole: its relief stays where it is. */
KERNEL vec3 surface_map(vec3 normal, vec3 tangent, float w, vec3 map, float front) {
    float side = front > 0.5f ? 1.0f : -1.0f;
    int mapped = (map.x != 0.0f) | (map.y != 0.0f);
    vec3 t = v3_madd(tangent, -v3_dot(tangent, normal), normal);
    float length2 = v3_dot(t, t);
    int usable = mapped & (length2 > 1e-12f * v3_dot(tangent, tangent));
    t = v3_scale(t, 1.0f / sqrtf(usable ? length2 : 1.0f));
    vec3 bitangent = v3_scale(v3_cross(normal, t), w * side);
    vec3 bent = v3_madd(v3_madd(v3_scale(normal, map.z), map.x * side, t), map.y * side, bitangent);
    float bent2 = v3_dot(bent, bent);
    usable = usable & (bent2 > 1e-12f);
    bent = v3_scale(bent, 1.0f / sqrtf(usable ? bent2 : 1.0f));
    return v3_select(usable, bent, normal);
}

/* The direction (u, v) of the tangent frame on the surface of a shading normal that faces wo, of unit length; any if there
 * is none. w, front: as above. */
KERNEL vec3 surface_along(vec3 normal, vec3 tangent, float w, float u, float v, float front) {
    float side = front > 0.5f ? 1.0f : -1.0f;
    vec3 t = v3_madd(tangent, -v3_dot(tangent, normal), normal), b = v3_scale(v3_cross(normal, t), w * side);
    vec3 along = v3_madd(v3_scale(t, u), v, b);
    float length2 = v3_dot(along, along);
    int usable = length2 > 1e-12f * v3_dot(tangent, tangent) * (u * u + v * v);
    return v3_select(usable, v3_scale(along, 1.0f / sqrtf(usable ? length2 : 1.0f)), frame_make(normal).x);
}

#endif
