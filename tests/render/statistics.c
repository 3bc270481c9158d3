#include "tests/render/statistics.h"

#include <math.h>
#include <stdlib.h>

vec3 stream_direction(stream *s) {
    double z = 1 - 2 * ((double)stream_next(s) + 0x1p-25), phi = 2 * M_PI * (double)stream_next(s), r = sqrt(1 - z * z);
    return v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

double normal_tail(double z) { return erfc(fabs(z) / M_SQRT2); }

/* Regularised incomplete gamma functions: P by its series (Abramowitz and Stegun 6.5.29), Q by Lentz's continued
 * fraction (6.5.31), each where it converges fast. */
static double gamma_p_series(double a, double x) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 1000 && term > 1e-16 * sum; n++) sum += term *= x / (a + n);
    return sum * exp(-x + a * log(x) - lgamma(a));
}
static double gamma_q_fraction(double a, double x) {
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 1000; i++) {
        double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (fabs(d * c - 1) < 1e-15) break;
    }
    return h * exp(-x + a * log(x) - lgamma(a));
}

double chi_square_tail(double x, double freedom) {
    double a = 0.5 * freedom, y = 0.5 * x;
    if (!(y > 0)) return 1;
    return y < a + 1 ? 1 - gamma_p_series(a, y) : gamma_q_fraction(a, y);
}

double sidak(double alpha, double n) { return -expm1(log1p(-alpha) / n); }

typedef struct cell { double observed, expected; } cell;

static int by_expectation(const void *a, const void *b) {
    double x = ((const cell *)a)->expected, y = ((const cell *)b)->expected;
    return (x > y) - (x < y);
}

double chi_square_p(const double *observed, const double *expected, size_t cells) {
    cell *sorted = calloc(cells, sizeof *sorted);
    for (size_t i = 0; i < cells; i++) sorted[i] = (cell){observed[i], expected[i]};
    qsort(sorted, cells, sizeof *sorted, by_expectation);
    cell pool = {0, 0};
    double sum = 0, freedom = -1;
    for (size_t i = 0; i < cells; i++) {
        pool.observed += sorted[i].observed;
        pool.expected += sorted[i].expected;
        if (pool.expected < 5 && i + 1 < cells) continue;
        if (!(pool.expected > 0)) continue;
        double d = pool.observed - pool.expected;
        sum += d * d / pool.expected;
        freedom++;
        pool = (cell){0, 0};
    }
    free(sorted);
    return freedom > 0 ? chi_square_tail(sum, freedom) : 1;
}

double tally_error(const tally *t) { return t->n > 1 ? sqrt(tally_variance(t) / t->n) : 0; }
