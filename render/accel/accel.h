/* render/accel/accel.h: which surface a ray meets first, and whether it meets any.
 *
 * The one place where rays reach Embree. Every ray is checked before: Debian's Embree 3 aborts on NaN, on a negative
 * tnear and on garbage in inactive lanes. */
#ifndef KILN_RENDER_ACCEL_ACCEL_H
#define KILN_RENDER_ACCEL_ACCEL_H

#include "render/accel/tape.h"
#include "render/sample/sampler.h"
#include "render/world/world.h"

typedef struct accel accel;

/* Robust traversal, always: it is what keeps shared edges closed and surfaces from hitting themselves. */
bool accel_create(world *, uint32_t threads, const char *embree_config, kiln_report *);
void accel_destroy(accel *);
size_t accel_bytes(const accel *);

/* "3.13.5", as the library that is loaded says. */
enum { EMBREE_VERSION_MAX = 32 };
void embree_version(char text[EMBREE_VERSION_MAX]);

#define TRIANGLE_NONE UINT32_MAX        /* the ray leaves the scene */
#define TRIANGLE_REFUSED (UINT32_MAX - 1) /* the ray was not one: non-finite, or of no direction */

/* What decides whether a ray stops at partial coverage: its sample_point, in arrays as the rays are, and the purpose and
 * depth that all of them have. */
typedef struct ray_coverage {
    const uint32_t *seed, *index; /* NULL, both: one point for all */
    uint32_t key; /* of the sampler */
    int independent;
} ray_coverage;

/* Rays as arrays, `count` of them, or those that lanes names. Directions are of unit length. */
typedef struct ray_lanes {
    const float *ox, *oy, *oz, *dx, *dy, *dz;
    const float *tnear, *tfar; /* NULL: the smallest above 0, infinity */
    ray_coverage coverage;
    const uint32_t *lanes;     /* NULL: 0 … count − 1 */
    uint32_t count;
    /* For the closest hit: each sixteen in a row run nearly alike, and always are the same sixteen: Embree then takes
     * them as one beam, in which ties between surfaces may depend on what else is in it. */
    bool coherent;
} ray_lanes;

typedef struct trace_counts {
    uint64_t rays, refused;
    ray_tape *tape; /* that keeps the rays; NULL: none */
} trace_counts;

/* The stages call instances of these that are compiled as they are; everyone else the plain ones. */
#ifdef KILN_ISA
#define ACCEL_PASTE(name, isa) name##_##isa
#define ACCEL_EXPAND(name, isa) ACCEL_PASTE(name, isa)
#define accel_closest ACCEL_EXPAND(accel_closest, KILN_ISA)
#define accel_visible ACCEL_EXPAND(accel_visible, KILN_ISA)
#define accel_visit ACCEL_EXPAND(accel_visit, KILN_ISA)
#endif

/* For each ray: the triangle (world's number, or TRIANGLE_…), its copy, distance and barycentric place. */
void accel_closest(const world *, const ray_lanes *, float *t, float *u, float *v, uint32_t *triangle,
                   uint32_t *instance, trace_counts *);

/* A surface that a ray meets; triangle and instance as above. */
typedef struct ray_crossing { uint32_t triangle, instance; float t, u, v; } ray_crossing;
typedef void ray_visitor(void *user, uint32_t ray, const ray_crossing *);

/* Shows every surface that each ray meets, in no order, now and then one twice. Only for worlds with solids. */
void accel_visit(const world *, const ray_lanes *, ray_visitor *, void *user, trace_counts *);

enum { RAY_STOPPED, RAY_REACHES, RAY_REFUSED };

/* For each ray: does it reach its end? */
void accel_visible(const world *, const ray_lanes *, uint32_t *visible, trace_counts *);

#endif
