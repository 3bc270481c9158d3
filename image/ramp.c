#include "image/ramp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"

void image_ramp(float share, float rgb[3]) {
    /* Chosen so that CIE L* is 0, 20, 40, 60, 80, 97. */
    static const float stops[][3] = {{0.000f, 0.000f, 0.000f}, {0.267f, 0.114f, 0.427f}, {0.690f, 0.141f, 0.361f},
                                     {0.933f, 0.416f, 0.263f}, {0.980f, 0.733f, 0.353f}, {1.000f, 0.976f, 0.800f}};
    enum { LAST = sizeof stops / sizeof *stops - 1 };
    float at = fminf(fmaxf(share, 0), 1) * LAST;
    int i = at < LAST ? (int)at : LAST - 1;
    for (int k = 0; k < 3; k++) rgb[k] = stops[i][k] + (at - (float)i) * (stops[i + 1][k] - stops[i][k]);
}

static int by_value(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

float image_ramp_end(const float *values, size_t count) {
    float *sorted = array_alloc(count, sizeof *sorted);
    if (!sorted) return -1;
    memcpy(sorted, values, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, by_value);
    float end = sorted[count - 1 - count / 1000], most = sorted[count - 1];
    free(sorted);
    return end > 0 ? end : most;
}
