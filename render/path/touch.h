/* render/path/touch.h: solids that touch: surfaces that coincide are one boundary. Scalar, on Embree's answers.
 *
 * A liquid that fills its glass has a wall in common with it. A ray meets one of the two surfaces, and would leave it
 * from behind the other. So what lies within the distance that rays leave out is looked for at every boundary, the
 * media on its far side are found from all of it, and the surface of the highest rank is the one that is shaded. */
#ifndef KILN_RENDER_PATH_TOUCH_H
#define KILN_RENDER_PATH_TOUCH_H

#include "render/accel/accel.h"
#include "render/path/medium.h"
#include "render/path/surface.h"
#include "render/world/lookup.h"

/* Surfaces of solids about one point of a ray. */
typedef struct touch {
    uint64_t entered, left; /* media whose fronts, and whose backs, are there; once: an edge shows two triangles */
    ray_crossing shaded;    /* of the highest rank */
    uint32_t medium;        /* its */
    int front;
} touch;

static inline int touch_has(uint64_t media, uint32_t medium) { return medium_leave(media, medium) != media; }

/* The same whatever the order: rank, then fronts, then the nearer, then by number. */
static inline int touch_prefers(const touch *t, const ray_crossing *c, uint32_t medium, int front) {
    if (medium != t->medium) return medium > t->medium;
    if (front != t->front) return front;
    if (c->t != t->shaded.t) return c->t < t->shaded.t;
    return c->triangle != t->shaded.triangle ? c->triangle < t->shaded.triangle : c->instance < t->shaded.instance;
}

/* A surface; others than of solids do not count. */
static inline void touch_add(touch *t, const world *w, vec3 direction, const ray_crossing *c) {
    uint32_t medium = w->materials[w->triangle_material[c->triangle]].medium;
    int front = v3_dot(lookup_facing(w, c->triangle, c->instance), direction) < 0.0f;
    uint64_t *side = front ? &t->entered : &t->left;
    if (!medium) return;
    if (!touch_has(*side, medium)) *side = medium_enter(*side, medium);
    if (t->medium && !touch_prefers(t, c, medium, front)) return;
    t->shaded = *c;
    t->medium = medium;
    t->front = front;
}

/* Entered first: what is met from both sides at once, as a blade is at its edge, is passed. */
static inline uint64_t touch_beyond(const touch *t, uint64_t media) {
    for (unsigned k = 0; k < 64 && t->entered >> k; k += 16) media = medium_enter(media, t->entered >> k & 0xffffu);
    for (unsigned k = 0; k < 64 && t->left >> k; k += 16) media = medium_leave(media, t->left >> k & 0xffffu);
    return media;
}

/* How far along a ray surfaces count as one with this: as far as a ray that leaves it starts off it. A ray that grazes
 * it more than 1 : 20 would take all that it meets along the way for one. */
static inline float touch_distance(const world *w, vec3 direction, uint32_t triangle, uint32_t instance) {
    vec3 p[3];
    lookup_corners(w, triangle, instance, p);
    vec3 e1 = v3_sub(p[1], p[0]), e2 = v3_sub(p[2], p[0]), n = v3_cross(e1, e2);
    n = v3_scale(n, 1.0f / fm_max(v3_length(n), 1e-37f)); /* Embree reports no hit on a triangle without area */
    return surface_reach(n, p[0], e1, e2, w->instances[instance].magnitude) / fm_max(fabsf(v3_dot(n, direction)), 0.05f);
}

#endif
