/* render/sample/filter.h: the reconstruction filter, importance-sampled: each sample belongs to one pixel, with
 * weight 1, and is displaced with the filter's own density. */
#ifndef KILN_RENDER_SAMPLE_FILTER_H
#define KILN_RENDER_SAMPLE_FILTER_H

#include <stdbool.h>

#include "base/kernel.h"
#include "kiln/render.h"

enum { FILTER_NODES = 512 };

/* Inverse cumulative distribution of one axis, linear between nodes: the filter is separable, and within 1/1000 of
 * its formula (a histogram of equal masses). */
typedef struct pixel_filter { float offset[FILTER_NODES + 1]; } pixel_filter;

/* width: diameter in pixels; 0: the kind's default. */
void pixel_filter_make(pixel_filter *, kiln_pixel_filter kind, double width);
double pixel_filter_default_width(kiln_pixel_filter kind);

/* Displacement from the pixel's centre for u in [0, 1). */
KERNEL float pixel_filter_offset(const pixel_filter *f, float u) {
    float at = u * (float)FILTER_NODES;
    int node = (int)at;
    float a = f->offset[node], b = f->offset[node + 1];
    return a + (at - (float)node) * (b - a);
}

#endif
