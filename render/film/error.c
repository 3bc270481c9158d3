/* render/film/error.c: how far the film is from its own expectation.
 *
 * relMSE is the mean over pixels and channels of (x − ref)²/(ref² + 0.01). Its numerator is estimated without bias by
 * the variance between replicates, each an independently scrambled sequence. Its denominator must not come from the
 * same pixel alone: a rare bright path raises the mean of its pixel as much as its spread, and would never cost more
 * than 1. ref is the mean of the 24 pixels around, where it is plausible. A bright path is in one replicate, so the
 * pixel's own mean is uncertain, and the neighbours have the word; an edge or a lamp is in both, and speaks for
 * itself. */
#include <stdlib.h>

#include "base/arena.h"
#include "base/threads.h"
#include "render/film/film.h"

enum { REACH = 2, PART = 32, SPAN = PART + 2 * REACH };

/* Values of a part of the film and of a margin around it, row by row. */
typedef double layer[SPAN][SPAN];

/* weight is 1 where a pixel counts; elsewhere, and outside the film, everything is 0. */
typedef struct part { layer weight, mean[3], variance[3]; } part;

/* A walk over the parts. */
typedef struct walk {
    const kiln_film *film;
    bool map;        /* values become the map that is shown, else what the estimate pools */
    bool everywhere; /* pixels without a surface count too */
    double scale;
    float *values;   /* one for each pixel */
} walk;

static uint32_t parts_across(const kiln_film *f) { return (f->width + PART - 1) / PART; }
static uint32_t parts_down(const kiln_film *f) { return (f->height + PART - 1) / PART; }

static void load(const walk *w, uint32_t x0, uint32_t y0, part *p) {
    const kiln_film *f = w->film;
    *p = (part){0};
    for (uint32_t j = y0 < REACH ? REACH : 0; j < SPAN && y0 + j < f->height + REACH; j++)
        for (uint32_t i = x0 < REACH ? REACH : 0; i < SPAN && x0 + i < f->width + REACH; i++) {
            size_t pixel = (size_t)(y0 + j - REACH) * f->width + (x0 + i - REACH);
            double mean[3], variance[3];
            if (f->counts[pixel] < KILN_REPLICATES || !(w->everywhere || f->hits[pixel])) continue;
            film_read_pixel(f, pixel, mean, variance);
            p->weight[j][i] = 1;
            for (int k = 0; k < 3; k++) p->mean[k][j][i] = mean[k], p->variance[k][j][i] = variance[k];
        }
}

/* Sums over 5 × 5 pixels, within the margin. */
static void box_sum(const layer values, layer sums) {
    layer rows;
    for (uint32_t j = 0; j < SPAN; j++)
        for (uint32_t i = REACH; i < SPAN - REACH; i++) {
            const double *v = &values[j][i];
            rows[j][i] = v[-2] + v[-1] + v[0] + v[1] + v[2];
        }
    for (uint32_t j = REACH; j < SPAN - REACH; j++)
        for (uint32_t i = REACH; i < SPAN - REACH; i++)
            sums[j][i] = rows[j - 2][i] + rows[j - 1][i] + rows[j][i] + rows[j + 1][i] + rows[j + 2][i];
}

/* Standard errors that the neighbours' mean may differ by to be the pixel's too. A bright path alone in one replicate
 * is 1 away from what the other replicate saw, which is itself uncertain. */
#define PLAUSIBLE 1.2

/* variance / (ref² + 0.01); around: sum and number of the neighbours. */
static double relative_error(double mean, double variance, double around, double count, double scale) {
    double ref = count > 0 ? around / count : mean, off = ref - mean;
    if (off * off > PLAUSIBLE * PLAUSIBLE * variance) ref = mean;
    return variance * scale * scale / (ref * ref * scale * scale + 0.01);
}

/* A pixel's relative error, mean over its channels; −1 where it does not count. around: sums over 5 × 5 means. */
static float pixel_error(const part *p, const layer count, const layer around[3], uint32_t j, uint32_t i, double scale) {
    double sum = 0;
    if (!(p->weight[j][i] > 0)) return -1;
    for (int k = 0; k < 3; k++)
        sum += relative_error(p->mean[k][j][i], p->variance[k][j][i], around[k][j][i] - p->mean[k][j][i],
                              count[j][i] - 1, scale);
    return (float)(sum / 3);
}

/* Standard error of the mean. One degree of freedom per pixel says little; 5 × 5 pixels share theirs. */
static float pooled_error(const layer count, const layer variances[3], uint32_t j, uint32_t i) {
    double all = variances[0][j][i] + variances[1][j][i] + variances[2][j][i], n = 3 * count[j][i];
    return n > 0 ? (float)sqrt(all / n) : 0.0f;
}

static void walk_part(void *context, size_t item, uint32_t thread) {
    (void)thread;
    const walk *w = context;
    const kiln_film *f = w->film;
    uint32_t x0 = (uint32_t)(item % parts_across(f)) * PART, y0 = (uint32_t)(item / parts_across(f)) * PART;
    part p;
    layer count, sum[3];
    load(w, x0, y0, &p);
    box_sum(p.weight, count);
    for (int k = 0; k < 3; k++) box_sum(w->map ? p.variance[k] : p.mean[k], sum[k]);
    for (uint32_t j = REACH; j < SPAN - REACH && y0 + j < f->height + REACH; j++)
        for (uint32_t i = REACH; i < SPAN - REACH && x0 + i < f->width + REACH; i++) {
            float *value = &w->values[(size_t)(y0 + j - REACH) * f->width + (x0 + i - REACH)];
            *value = w->map ? pooled_error(count, sum, j, i) : pixel_error(&p, count, sum, j, i, w->scale);
        }
}

static void walk_parts(walk w) {
    threads_for(w.film->desc.threads, (size_t)parts_across(w.film) * parts_down(w.film), walk_part, &w);
}

/* Floats that are not negative are in the order of their bits. Those of a bucket share the upper half of them, and are
 * within a hundredth of each other: of the last one, the mean stands for all. False: out of memory. */
static bool sum_of_largest(const float *values, size_t n, size_t count, double *sum) {
    typedef struct bucket { double sum; size_t count; } bucket;
    enum { BUCKETS = 1 << 15 };
    bucket *buckets = array_alloc(BUCKETS, sizeof *buckets);
    *sum = 0;
    for (size_t i = 0; buckets && i < n; i++) {
        if (values[i] < 0) continue;
        bucket *b = &buckets[fm_bits(values[i]) >> 16];
        b->sum += (double)values[i];
        b->count++;
    }
    for (size_t k = BUCKETS; buckets && count && k-- > 0;) {
        size_t taken = count < buckets[k].count ? count : buckets[k].count;
        if (taken) *sum += buckets[k].sum * ((double)taken / (double)buckets[k].count);
        count -= taken;
    }
    free(buckets);
    return buckets != NULL;
}

/* What the estimate was seen to be off by, in relMSE, on scenes of all kinds: its denominators come from neighbours. */
#define METHOD_ERROR 0.1

/* The estimate is a sum of squared deviations: about chi-square, with ν = 2/cv² degrees of freedom (Satterthwaite
 * 1946), where cv is its relative standard deviation. Quantiles are Wilson and Hilferty's (1931): ν (1 − h ± 1.96 √h)³,
 * h = 2/(9 ν). */
static void set_interval(kiln_film_error *e, double cv2) {
    double h = (cv2 + METHOD_ERROR * METHOD_ERROR) / 9, middle = 1 - h, reach = 1.96 * sqrt(h);
    e->relmse_low = e->relmse / pow(middle + reach, 3);
    e->relmse_high = e->relmse / pow(middle - reach, 3); /* > 0: cv² < 1, for no term is more than the sum */
}

enum { WORST = 100, TAIL_PIXELS = 1000 };

static bool summarise(const float *errors, size_t pixels, kiln_film_error *e) {
    double n = 0, sum = 0, squares = 0, top;
    for (size_t i = 0; i < pixels; i++) {
        double r = (double)errors[i];
        if (r < 0) continue;
        n++;
        sum += r;
        squares += r * r;
    }
    size_t worst = (size_t)n / WORST > 0 ? (size_t)n / WORST : 1;
    if (!sum_of_largest(errors, pixels, worst, &top)) return false;
    *e = (kiln_film_error){.known = true, .relmse = sum / n, .relmse_trimmed = fmax(sum - top, 0) / n};
    set_interval(e, sum > 0 ? fmax(squares / (sum * sum) - 1 / n, 0) : 0);
    e->heavy_tail = n >= TAIL_PIXELS && e->relmse_trimmed < 0.5 * e->relmse;
    return true;
}

kiln_film_error kiln_film_estimate_error(const kiln_film *f, double scale) {
    kiln_film_error e = {0};
    size_t pixels = (size_t)f->width * f->height;
    if (kiln_film_spp(f) < KILN_REPLICATES) return e;
    walk w = {.film = f, .everywhere = true, .scale = scale, .values = array_alloc(pixels, sizeof(float))};
    if (!w.values) return e;
    for (size_t i = 0; w.everywhere && i < pixels; i++) w.everywhere = !f->hits[i];
    walk_parts(w);
    if (!summarise(w.values, pixels, &e)) e = (kiln_film_error){0};
    free(w.values);
    return e;
}

void film_relative_errors(const kiln_film *f, double scale, float *values) {
    walk_parts((walk){.film = f, .everywhere = true, .scale = scale, .values = values});
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        if (values[i] < 0) values[i] = 0;
}

void film_error_map(const kiln_film *f, float *values) {
    walk_parts((walk){.film = f, .map = true, .everywhere = true, .values = values});
}
