/* kiln/film.h: the Film: what a render has summed so far.
 *
 * Sums are 128-bit fixed point, so that no order or grouping of samples can change a bit. They are kept in
 * KILN_REPLICATES independently scrambled replicates, from which the error is estimated. A film can be rendered
 * into again: samples that it already holds are not repeated. */
#ifndef KILN_FILM_H
#define KILN_FILM_H

#include "kiln/api.h"
#include "kiln/report.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One kiln_render at a time writes a film, and nobody may read it meanwhile; else any number of threads may read. */
typedef struct kiln_film kiln_film;

/* What a film can hold beside the beauty: bit, name (option, EXR layer), channels, what it is. */
#define KILN_AOVS(X)                                                                                                   \
    X(ALPHA, "alpha", 1, "coverage: 0 where the camera sees nothing but the background")                               \
    X(ALBEDO, "albedo", 3, "directional albedo of the first surface, in the working space")                            \
    X(NORMAL, "normal", 3, "shading normal of the first surface, world space")                                         \
    X(DEPTH, "depth", 1, "metres along the camera's axis to the first surface, averaged over the samples that hit")    \
    X(SAMPLES, "samples", 1, "samples taken in the pixel")                                                             \
    X(ERROR, "error", 1, "estimated standard error of the pixel, root of the mean over the channels")

typedef enum kiln_aov {
#define KILN_AOV_INDEX(id, name, channels, text) KILN_AOV_##id,
    KILN_AOVS(KILN_AOV_INDEX)
#undef KILN_AOV_INDEX
        KILN_AOV_COUNT
} kiln_aov;

typedef struct kiln_film_desc {
    uint32_t width, height;     /* of the whole picture, 1 … 65,536 */
    uint32_t crop[4];           /* x0, y0, x1, y1, right and bottom exclusive; all zero: the whole picture */
    uint32_t aovs;              /* bits 1 << kiln_aov */
    uint32_t threads;           /* that may estimate the error; 0: every core that the process may use */
} kiln_film_desc;

/* Memory that such a film takes. */
KILN_API uint64_t kiln_film_size(const kiln_film_desc *);

/* An empty film. On failure *film is NULL: sizes or crop out of range, an AOV that does not exist, no memory. */
KILN_API bool kiln_film_create(const kiln_film_desc *, kiln_film **film, kiln_report *);
KILN_API void kiln_film_destroy(kiln_film *); /* NULL: nothing happens */
KILN_API kiln_film_desc kiln_film_describe(const kiln_film *); /* crop always filled in */

/* The means so far, as floats: (x1 − x0) × (y1 − y0) × channels, rows from the top, into the caller's array. Beauty is
 * radiance in cd/m² per channel, in the working space of the renderer's decoding; 0 where there are no samples yet. */
KILN_API void kiln_film_beauty(const kiln_film *, float *rgb);
KILN_API bool kiln_film_aov(const kiln_film *, kiln_aov, float *values); /* false: the film does not hold it */

/* What the film knows of its own accuracy (docs/estimator.md). Pixels count where the camera sees a surface, so that an
 * empty background does not make a picture look better; all of them when it sees none. */
typedef struct kiln_film_error {
    bool known;            /* false before every replicate of every pixel has a sample, or when memory is exhausted */
    double relmse;         /* mean over pixels and channels of variance / (ref² + 0.01) */
    double relmse_trimmed; /* without the share of the worst 1 % of the pixels */
    double relmse_low, relmse_high; /* 95 % interval of the true relMSE at this number of samples */
    bool heavy_tail;       /* the worst 1 % hold most of the error: more of it is likely to be unseen as yet */
} kiln_film_error;
/* scale multiplies the picture first (2^exposure): the 0.01 is a matter of what is seen. */
KILN_API kiln_film_error kiln_film_estimate_error(const kiln_film *, double scale);

KILN_API uint64_t kiln_film_samples(const kiln_film *);      /* in all pixels together */
KILN_API uint32_t kiln_film_spp(const kiln_film *);          /* samples in every pixel, finished passes alone */
KILN_API size_t kiln_film_bytes(const kiln_film *);          /* memory of the sums */

#ifdef __cplusplus
}
#endif
#endif
