/* kiln/compare.h: how far a picture is from a reference, as numbers and as a map. */
#ifndef KILN_COMPARE_H
#define KILN_COMPARE_H

#include "kiln/api.h"
#include "kiln/report.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Identifier, name, what it is of values x against reference values r. Each is a mean over the pixels of a map; the
 * first three are of the numbers as they are, and a pixel's value is the mean over its channels.
 *
 * FLIP (Andersson et al. 2020) tells what somebody sees who flips between two pictures on a display, 0 … 1. It wants
 * display-referred sRGB in [0,1]; what lies beyond is clamped. HDR_FLIP (Andersson et al. 2021) wants scene-linear
 * Rec.709: the largest FLIP over the exposures from the one that shows the reference's brightest pixel to the one that
 * shows its median, about a stop apart. */
#define KILN_METRICS(X)                                                                                                \
    X(RELMSE, "relmse", "mean of (x - r)^2 / (r^2 + 0.01)")                                                            \
    X(MSE, "mse", "mean of (x - r)^2")                                                                                 \
    X(MAE, "mae", "mean of |x - r|")                                                                                   \
    X(FLIP, "flip", "what an observer sees who flips between the pictures")                                            \
    X(HDR_FLIP, "hdr-flip", "the same over all exposures at which the reference can be looked at")

typedef enum kiln_metric {
#define KILN_METRIC_ENUM(id, name, text) KILN_METRIC_##id,
    KILN_METRICS(KILN_METRIC_ENUM)
#undef KILN_METRIC_ENUM
        KILN_METRIC_COUNT
} kiln_metric;

KILN_API const char *kiln_metric_name(kiln_metric); /* "hdr-flip" */

typedef struct kiln_comparison {
    kiln_metric metric;
    uint32_t width, height;        /* 1 … 65,536 */
    const float *image, *reference; /* RGB, interleaved, rows from the top */
    double pixels_per_degree;      /* FLIP: of visual angle; 0: 67.02, a 4K display 0.7 m wide seen from 0.7 m */
    uint32_t threads;              /* 0: every core that the process may use; the values are the same for any number */
} kiln_comparison;

/* *error is the mean of the map; map, where it is not NULL, gets width × height values, the error of each pixel. False:
 * reported: a value that is not finite, in either picture; no memory. */
KILN_API bool kiln_compare(const kiln_comparison *, double *error, float *map, kiln_report *);

#ifdef __cplusplus
}
#endif
#endif
