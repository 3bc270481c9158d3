/* tests/render/statistics.h: random numbers, and whether a deviation is chance. */
#ifndef KILN_TESTS_RENDER_STATISTICS_H
#define KILN_TESTS_RENDER_STATISTICS_H

#include <stddef.h>
#include <stdint.h>

#include "base/hash.h"
#include "base/vec.h"

/* Under a sanitizer, which takes six times as long and looks at the code and not at the numbers, grids of roughness take
 * one step in so many. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { SPARSE = 4 };
#else
enum { SPARSE = 1 };
#endif

/* Random numbers that owe nothing to the sampler under test. */
typedef struct stream { uint32_t seed, count; } stream;
static inline float stream_next(stream *s) { return unit_float(hash_pair(s->seed, s->count++)); }
static inline vec2 stream_pair(stream *s) {
    float x = stream_next(s);
    return (vec2){x, stream_next(s)};
}
static inline float stream_between(stream *s, float low, float high) { return low + stream_next(s) * (high - low); }
vec3 stream_direction(stream *); /* uniform on the sphere */

/* Probability of a deviation of at least |z| standard deviations to either side. */
double normal_tail(double z);
/* Probability of a chi-square statistic of at least x with so many degrees of freedom. */
double chi_square_tail(double x, double freedom);
/* The level of each of n independent tests whose joint level is alpha (Šidák 1967). */
double sidak(double alpha, double n);

/* Pearson's test of counts against what is expected of them; both have the same sum. Cells that expect fewer than five are
 * pooled. */
double chi_square_p(const double *observed, const double *expected, size_t cells);

/* Mean and its standard error, of values added one by one (Welford 1962). */
typedef struct tally { double n, mean, squares; } tally;
static inline void tally_add(tally *t, double x) {
    double d = x - t->mean;
    t->n += 1;
    t->mean += d / t->n;
    t->squares += d * (x - t->mean);
}
static inline double tally_variance(const tally *t) { return t->n > 1 ? t->squares / (t->n - 1) : 0; }
double tally_error(const tally *);

#endif
