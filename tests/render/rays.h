/* tests/render/rays.h: rays as arrays, and meshes that are hard to hit. */
#ifndef KILN_TESTS_RENDER_RAYS_H
#define KILN_TESTS_RENDER_RAYS_H

#include "render/accel/accel.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

/* Rays and what is known of them. */
typedef struct rays {
    uint32_t count;
    float *ox, *oy, *oz, *dx, *dy, *dz, *tnear, *tfar;
    float *t, *u, *v;
    uint32_t *triangle, *instance, *visible;
    trace_counts counts;
} rays;

rays rays_make(uint32_t count); /* from the smallest distance to infinity */
void rays_free(rays *);
void rays_set(rays *, uint32_t i, vec3 origin, vec3 direction);
vec3 rays_origin(const rays *, uint32_t i);
vec3 rays_direction(const rays *, uint32_t i);
/* Origins in the cube of that half side, directions anywhere. */
rays rays_random(uint32_t count, float reach, uint32_t seed);

/* Those of list, or the first count. */
void rays_closest(const world *, rays *, const uint32_t *list, uint32_t count);
void rays_visible(const world *, rays *);

vec3 stream_point(stream *, float reach); /* in that cube */

/* Triangles about 1 long and so wide, in all directions. */
void add_slivers(scene_builder *, stream *, uint32_t count, float width);
/* A grid of waves, 2 n² triangles between −1 and 1, that nothing shows yet. */
kiln_id add_waves(scene_builder *, kiln_id material, uint32_t n);
/* So many copies of a mesh about the origin: turned, squeezed, every other one mirrored. */
void add_copies(scene_builder *, kiln_id mesh, uint32_t count, stream *);

#endif
