/* image/flip.h: what an observer sees who flips between two pictures. */
#ifndef KILN_IMAGE_FLIP_H
#define KILN_IMAGE_FLIP_H

#include "kiln/compare.h"

/* width × height values in [0,1]. False: out of memory. */
bool flip(const kiln_comparison *, float *map);     /* of sRGB */
bool flip_hdr(const kiln_comparison *, float *map); /* of scene-linear Rec.709 */

/* Linear Rec.709 in [0,1] of both pictures, three planes each, which are overwritten. */
typedef struct flip_planes {
    uint32_t width, height, threads;
    double pixels_per_degree;
    float *image, *reference;
} flip_planes;
bool flip_of_linear(flip_planes *, float *map);

/* flip_filter.c: filters of eyes, applied to planes whose borders go on forever. */

/* Filters the three channels of YCxCz by the sensitivity of eyes to contrast; scratch as large as the three. */
bool flip_blur(const flip_planes *, float *planes, float *scratch);
/* How strong edges and points are in a plane of luminance; scratch: two planes. */
typedef struct flip_features { float *edges, *points; } flip_features;
bool flip_detect(const flip_planes *, const float *plane, flip_features, float *scratch);

#endif
