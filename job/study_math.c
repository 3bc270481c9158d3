#include "job/study_math.h"

#include <math.h>

static const study_range unknown = {NAN, NAN, NAN};

/* A table, then Cornish and Fisher's expansion (Abramowitz and Stegun 26.7.5), whose error is below 2 10⁻⁴ there. */
double study_student(size_t freedom) {
    static const double first[] = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281};
    const double z = 1.959964, n = (double)freedom, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
    if (freedom <= sizeof first / sizeof *first) return first[freedom ? freedom - 1 : 0];
    return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
           (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

static study_range interval(const double *values, size_t count, double (*map)(double)) {
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(map(values[i]))) sum += map(values[i]), n++;
    if (n < 1) return unknown;
    double mean = sum / n;
    for (size_t i = 0; i < count; i++)
        if (isfinite(map(values[i]))) squares += (map(values[i]) - mean) * (map(values[i]) - mean);
    if (n < 2) return (study_range){mean, NAN, NAN};
    double half = study_student((size_t)n - 1) * sqrt(squares / (n * (n - 1)));
    return (study_range){mean, mean - half, mean + half};
}

static double same(double v) { return v; }

study_range study_interval(const double *values, size_t count) { return interval(values, count, same); }

study_range study_interval_of_logs(const double *values, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!(values[i] > 0)) return unknown;
    study_range logs = interval(values, count, log);
    return (study_range){exp(logs.mean), exp(logs.low), exp(logs.high)};
}

study_range study_slope_of_logs(const double *x, const double *y, size_t count) {
    double n = 0, mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
    for (int turn = 0; turn < 2; turn++) {
        for (size_t i = 0; i < count; i++) {
            if (!(x[i] > 0 && y[i] > 0 && isfinite(x[i] * y[i]))) continue;
            double u = log(x[i]) - mx, v = log(y[i]) - my;
            if (turn) xx += u * u, xy += u * v, yy += v * v;
            else n++, xx += u, yy += v;
        }
        if (turn || n < 3) break;
        mx = xx / n, my = yy / n;
        xx = yy = 0;
    }
    if (n < 3 || !(xx > 0)) return unknown;
    double slope = xy / xx, rest = fmax(yy - slope * xy, 0);
    double half = study_student((size_t)n - 2) * sqrt(rest / ((n - 2) * xx));
    return (study_range){slope, slope - half, slope + half};
}

void study_front(const double *time, const double *error, size_t count, bool *front) {
    for (size_t i = 0; i < count; i++) {
        front[i] = isfinite(time[i]) && isfinite(error[i]);
        for (size_t k = 0; front[i] && k < count; k++) {
            bool no_worse = time[k] <= time[i] && error[k] <= error[i];
            front[i] = !(no_worse && (time[k] < time[i] || error[k] < error[i]));
        }
    }
}
