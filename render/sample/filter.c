#include "render/sample/filter.h"

#include <math.h>

/* The filter at x in [−1, 1] of its radius. */
static double value(kiln_pixel_filter kind, double x) {
    switch (kind) {
    case KILN_PIXEL_BLACKMAN_HARRIS: { /* Harris 1978, the minimum 4-term window */
        double t = M_PI * (x + 1);
        return 0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2 * t) - 0.01168 * cos(3 * t);
    }
    case KILN_PIXEL_GAUSSIAN: return exp(-0.5 * 9 * x * x); /* cut at three standard deviations */
    case KILN_PIXEL_BOX: break;
    }
    return 1;
}

double pixel_filter_default_width(kiln_pixel_filter kind) { return kind == KILN_PIXEL_BOX ? 1 : 3; }

void pixel_filter_make(pixel_filter *f, kiln_pixel_filter kind, double width) {
    enum { STEPS = 1 << 14 };
    if (!(width > 0)) width = pixel_filter_default_width(kind);
    double total = 0, sum = 0;
    for (int i = 0; i < STEPS; i++) total += value(kind, 2 * (i + 0.5) / STEPS - 1);
    int node = 0;
    for (int i = 0; i < STEPS; i++) {
        double mass = value(kind, 2 * (i + 0.5) / STEPS - 1) / total;
        for (; node <= FILTER_NODES && (double)node / FILTER_NODES <= sum + mass; node++) {
            double inside = mass > 0 ? ((double)node / FILTER_NODES - sum) / mass : 0;
            f->offset[node] = (float)((2 * (i + inside) / STEPS - 1) * 0.5 * width);
        }
        sum += mass;
    }
    for (; node <= FILTER_NODES; node++) f->offset[node] = (float)(0.5 * width);
}
