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

void coverage_filter(const struct RTCFilterFunctionNArguments *);

#endif
