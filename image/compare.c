/* image/compare.c: metrics of single numbers; flip.c has those of what is seen. */
#include "kiln/compare.h"

#include <math.h>
#include <stdlib.h>

#include "base/arena.h"
#include "base/report.h"
#include "image/flip.h"

const char *kiln_metric_name(kiln_metric metric) {
    static const char *const names[KILN_METRIC_COUNT] = {
#define KILN_METRIC_NAME(id, name, text) name,
        KILN_METRICS(KILN_METRIC_NAME)
#undef KILN_METRIC_NAME
    };
    return names[metric];
}

static bool check(const float *values, const kiln_comparison *c, const char *whose, kiln_report *report) {
    size_t count = (size_t)c->width * c->height, bad = 0, first = 0;
    for (size_t i = count; i-- > 0;) {
        const float *v = values + 3 * i;
        if (isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2])) continue;
        bad++;
        first = i;
    }
    return !bad || report_error(report, KILN_CODE_RANGE, NULL, NULL,
                                "%zu pixel%s of the %s hold%s what is no finite number, the first at %zu,%zu", bad,
                                bad == 1 ? "" : "s", whose, bad == 1 ? "s" : "", first % c->width, first / c->width);
}

static double difference(kiln_metric metric, double x, double r) {
    double d = x - r;
    switch (metric) {
    case KILN_METRIC_RELMSE: return d * d / (r * r + 0.01); /* 0.01: black pixels count, and not without bounds */
    case KILN_METRIC_MSE: return d * d;
    case KILN_METRIC_MAE: return fabs(d);
    case KILN_METRIC_FLIP:
    case KILN_METRIC_HDR_FLIP:
    case KILN_METRIC_COUNT: break;
    }
    return NAN;
}

static bool compare_seen(const kiln_comparison *c, double *error, float *map, kiln_report *report) {
    size_t count = (size_t)c->width * c->height;
    float *own = map ? NULL : array_alloc(count, sizeof *own), *seen = map ? map : own;
    bool done = seen && (c->metric == KILN_METRIC_FLIP ? flip(c, seen) : flip_hdr(c, seen));
    double sum = 0;
    for (size_t i = 0; done && i < count; i++) sum += (double)seen[i];
    *error = sum / (double)count;
    free(own);
    return done || report_no_memory(report, "comparing pictures");
}

bool kiln_compare(const kiln_comparison *c, double *error, float *map, kiln_report *report) {
    *error = NAN;
    if (!check(c->image, c, "picture", report) || !check(c->reference, c, "reference", report)) return false;
    if (c->metric == KILN_METRIC_FLIP || c->metric == KILN_METRIC_HDR_FLIP) return compare_seen(c, error, map, report);
    size_t count = (size_t)c->width * c->height;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double pixel = 0;
        for (size_t k = 3 * i; k < 3 * i + 3; k++)
            pixel += difference(c->metric, (double)c->image[k], (double)c->reference[k]) / 3;
        sum += pixel;
        if (map) map[i] = (float)pixel;
    }
    *error = sum / (double)count;
    return true;
}
