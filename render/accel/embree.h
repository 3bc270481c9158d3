/* render/accel/embree.h: Embree 3 and Embree 4 under one spelling. The only file that includes Embree. */
#ifndef KILN_RENDER_ACCEL_EMBREE_H
#define KILN_RENDER_ACCEL_EMBREE_H

#include "base/vec.h"

#if KILN_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext embree_context;
#define EMBREE_QUERY_FILTERS RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
#else
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext embree_context;
#define EMBREE_QUERY_FILTERS RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS
#endif

/* Packets of 16, and nothing else: one width gives the same bits whatever the number of rays (docs/estimator.md). */
#if KILN_EMBREE_MAJOR == 3
static inline void embree_init_context(embree_context *c) { rtcInitIntersectContext(c); }
static inline void embree_intersect16(const int *valid, RTCScene scene, embree_context *c, bool coherent,
                                      struct RTCRayHit16 *rays) {
    c->flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, c, rays);
}
static inline void embree_occluded16(const int *valid, RTCScene scene, embree_context *c, struct RTCRay16 *rays) {
    rtcOccluded16(valid, scene, c, rays);
}
/* Shows every hit to the filter; the scene has EMBREE_QUERY_FILTERS. */
static inline void embree_visit16(const int *valid, RTCScene scene, embree_context *c, RTCFilterFunctionN filter,
                                  struct RTCRay16 *rays) {
    c->filter = filter;
    rtcOccluded16(valid, scene, c, rays);
}
#else
static inline void embree_init_context(embree_context *c) { rtcInitRayQueryContext(c); }
static inline void embree_intersect16(const int *valid, RTCScene scene, embree_context *c, bool coherent,
                                      struct RTCRayHit16 *rays) {
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = c;
    args.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, rays, &args);
}
static inline void embree_occluded16(const int *valid, RTCScene scene, embree_context *c, struct RTCRay16 *rays) {
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = c;
    rtcOccluded16(valid, scene, rays, &args);
}
static inline void embree_visit16(const int *valid, RTCScene scene, embree_context *c, RTCFilterFunctionN filter,
                                  struct RTCRay16 *rays) {
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = c;
    args.filter = filter;
    args.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcOccluded16(valid, scene, rays, &args);
}
#endif

#endif
