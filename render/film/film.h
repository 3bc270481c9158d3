/* render/film/film.h: the film's sums, for the one renderer that writes them. The reading side is public. */
#ifndef KILN_RENDER_FILM_FILM_H
#define KILN_RENDER_FILM_FILM_H

#include "kiln/film.h"
#include "render/film/fixed.h"
#include "render/sample/sampler.h"

typedef struct film_pixel { fixed sum[KILN_REPLICATES][3]; } film_pixel;

struct kiln_film {
    kiln_film_desc desc;      /* crop filled in */
    uint32_t width, height;   /* of the crop */
    film_pixel *pixels;       /* row by row, as everything below */
    uint32_t *counts;         /* samples so far: sample n of a pixel belongs to replicate n mod KILN_REPLICATES */
    uint32_t *hits;           /* those whose camera ray met a surface */
    fixed *aovs[KILN_AOV_COUNT]; /* sums, channels interleaved; NULL: not held, or not a sum */
    fixed beyond[3];          /* radiance that probes found beyond the depth limit, all pixels */
};

/* What one sample brings. */
typedef struct film_sample {
    float radiance[3];
    float alpha, depth, albedo[3], normal[3];
} film_sample;

/* Adds the next sample of a pixel (coordinates within the crop). Values fit. Threads may add to different pixels at the
 * same time. */
void film_add(kiln_film *, uint32_t x, uint32_t y, const film_sample *);

/* Mean radiance, and the variance of that mean as the replicates show it; variance < 0: unknown. */
void film_read_pixel(const kiln_film *, size_t pixel, double mean[3], double variance[3]);

/* Standard error by pixel, from its neighbourhood's replicates. */
void film_error_map(const kiln_film *, float *values);

#endif
