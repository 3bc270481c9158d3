/* render/accel/coverage.h: partial coverage (alpha) as Embree's filter.
 *
 * MASK compares alpha with a cutoff; BLEND is a coin that is a pure function of (ray, triangle), so neither the order in
 * which Embree visits triangles nor a second visit can change an outcome. Each triangle has a sequence of its own:
 * stratified over the samples of a pixel, and independent of the sheets before and behind it. */
#ifndef KILN_RENDER_ACCEL_COVERAGE_H
#define KILN_RENDER_ACCEL_COVERAGE_H

#include "render/accel/accel.h"
#include "render/accel/embree.h"

/* What a query hands to the filter; Embree's context comes first. */
typedef struct coverage_context {
    embree_context embree;
    const world *world;
    const ray_coverage *coverage; /* arrays by ray id */
} coverage_context;

/* Arrays of N, as Embree lays out RTCRayN and RTCHitN; its C++ accessors are no use to C. */
enum { RAY_T = 8, RAY_ID = 10, HIT_U = 3, HIT_V = 4, HIT_PRIMITIVE = 5, HIT_GEOMETRY = 6, HIT_INSTANCE = 7 };

/* Which triangle, and of which copy, the k-th hit of N is. */
static inline uint32_t filter_triangle(const world *w, const uint32_t *hit, size_t n, size_t k, uint32_t *instance) {
    uint32_t placed = hit[HIT_INSTANCE * n + k];
    *instance = placed == RTC_INVALID_GEOMETRY_ID ? 0 : placed - 1;
    return w->instances[*instance].triangle_base[hit[HIT_GEOMETRY * n + k]] + hit[HIT_PRIMITIVE * n + k];
}

void coverage_filter(const struct RTCFilterFunctionNArguments *);

#endif
