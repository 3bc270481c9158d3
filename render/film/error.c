/* render/film/error.c: how far the film is from its own expectation.
 *
 * relMSE is the mean over pixels and channels of (x − ref)²/(ref² + 0.01). Its numerator is estimated without bias by the
 * variance between replicates, each an independently scrambled sequence. */
#include <stdlib.h>
#include <string.h>

#include "render/film/film.h"

/* Relative error of one pixel, mean over its channels; < 0: unknown. */
static double pixel_error(const kiln_film *f, size_t pixel, double scale) {
    double mean[3], variance[3], sum = 0;
    film_read_pixel(f, pixel, mean, variance);
    if (variance[0] < 0) return -1;
    for (int k = 0; k < 3; k++) {
        double m = mean[k] * scale;
        sum += variance[k] * scale * scale / (m * m + 0.01);
    }
    return sum / 3;
}

static int descending(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x < y) - (x > y);
}

/* The `count` largest values come first, in any order: a selection by sorting buckets would be no faster at this size. */
static double sum_of_largest(float *values, size_t n, size_t count) {
    qsort(values, n, sizeof *values, descending);
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i];
    return sum;
}

kiln_film_error kiln_film_estimate_error(const kiln_film *f, double scale) {
    kiln_film_error e = {0};
    size_t pixels = (size_t)f->width * f->height, worst = pixels / 1000 > 0 ? pixels / 1000 : 1;
    float *errors = malloc(pixels * sizeof *errors);
    double sum = 0, squares = 0;
    bool known = errors != NULL;
    for (size_t i = 0; known && i < pixels; i++) {
        double r = pixel_error(f, i, scale);
        known = r >= 0;
        sum += r;
        squares += r * r;
        errors[i] = (float)r;
    }
    if (known) {
        double n = (double)pixels, spread = sqrt(fmax(squares / n - sum / n * (sum / n), 0) / n);
        double top = sum_of_largest(errors, pixels, worst);
        e = (kiln_film_error){.known = true,
                              .relmse = sum / n,
                              .relmse_trimmed = fmax(sum - top, 0) / n,
                              .relmse_low = fmax(sum / n - 1.96 * spread, 0),
                              .relmse_high = sum / n + 1.96 * spread,
                              .heavy_tail = pixels >= 1000 && top > 0.5 * sum};
    }
    free(errors);
    return e;
}

/* One degree of freedom per pixel says little; a neighbourhood of 5 × 5 shares its own. */
void film_error_map(const kiln_film *f, float *values) {
    enum { REACH = 2 };
    for (uint32_t y = 0; y < f->height; y++)
        for (uint32_t x = 0; x < f->width; x++) {
            uint32_t x0 = x > REACH ? x - REACH : 0, x1 = x + REACH < f->width ? x + REACH : f->width - 1;
            uint32_t y0 = y > REACH ? y - REACH : 0, y1 = y + REACH < f->height ? y + REACH : f->height - 1;
            double sum = 0, count = 0, mean[3], variance[3];
            for (uint32_t j = y0; j <= y1; j++)
                for (uint32_t i = x0; i <= x1; i++) {
                    film_read_pixel(f, (size_t)j * f->width + i, mean, variance);
                    if (variance[0] < 0) continue;
                    sum += (variance[0] + variance[1] + variance[2]) / 3;
                    count++;
                }
            values[(size_t)y * f->width + x] = count > 0 ? (float)sqrt(sum / count) : 0.0f;
        }
}
