/* image/flip_filter.c: the filters of FLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP:
 * A Difference Evaluator for Alternating Images", 2020, sections 4.1.1 and 4.2. All are sums of products of a filter in
 * x and one in y. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/threads.h"
#include "image/flip.h"

/* Taps −radius … radius. */
typedef struct filter {
    float *taps;
    int radius;
} filter;

typedef struct pass {
    const flip_planes *p;
    const float *from;
    float *to;
    filter f;
    float weight; /* the result is multiplied by it and, */
    bool add;     /* added to what is there */
} pass;

static void store(const pass *s, size_t i, float sum) {
    s->to[i] = (s->add ? s->to[i] : 0) + s->weight * sum;
}

static int clamp(int v, int most) { return v < 0 ? 0 : v > most ? most : v; }

static void filter_row(void *context, size_t y, uint32_t thread) {
    (void)thread;
    const pass *s = context;
    int width = (int)s->p->width;
    const float *row = s->from + y * (size_t)width;
    for (int x = 0; x < width; x++) {
        float sum = 0;
        for (int k = -s->f.radius; k <= s->f.radius; k++)
            sum += s->f.taps[k + s->f.radius] * row[clamp(x + k, width - 1)];
        store(s, y * (size_t)width + (size_t)x, sum);
    }
}

static void filter_column_of_row(void *context, size_t y, uint32_t thread) {
    (void)thread;
    const pass *s = context;
    size_t width = s->p->width;
    for (size_t x = 0; x < width; x++) {
        float sum = 0;
        for (int k = -s->f.radius; k <= s->f.radius; k++)
            sum += s->f.taps[k + s->f.radius] * s->from[(size_t)clamp((int)y + k, (int)s->p->height - 1) * width + x];
        store(s, y * width + x, sum);
    }
}

static void along_x(const flip_planes *p, const float *from, float *to, filter f) {
    pass s = {p, from, to, f, 1, false};
    threads_for(p->threads, p->height, filter_row, &s);
}

static void along_y(const flip_planes *p, const float *from, float *to, filter f, float weight, bool add) {
    pass s = {p, from, to, f, weight, add};
    threads_for(p->threads, p->height, filter_column_of_row, &s);
}

static bool make_filter(filter *f, double radius) {
    f->radius = (int)ceil(radius);
    f->taps = array_alloc(2 * (size_t)f->radius + 1, sizeof *f->taps);
    return f->taps != NULL;
}

/* exp(−π² x²/b), x in degrees, divided by its sum; that is also returned. */
static double make_sensitivity(filter *f, double b, double pixels_per_degree) {
    double sum = 0;
    for (int k = -f->radius; k <= f->radius; k++) {
        double x = k / pixels_per_degree;
        sum += exp(-M_PI * M_PI * x * x / b);
    }
    for (int k = -f->radius; k <= f->radius; k++) {
        double x = k / pixels_per_degree;
        f->taps[k + f->radius] = (float)(exp(-M_PI * M_PI * x * x / b) / sum);
    }
    return sum;
}

/* Sensitivities to contrast in space, Σ a √(π/b) exp(−π² d²/b), table 1: of luminance, red-green, blue-yellow. */
typedef struct sensitivity { double a[2], b[2]; } sensitivity;
static const sensitivity sensitivities[3] = {
    {{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};

static void blur_channel(const flip_planes *p, const sensitivity *s, filter f, float *plane, float *scratch) {
    size_t count = (size_t)p->width * p->height;
    float *wide = scratch, *result = scratch + count;
    double share[2], total = 0;
    for (int i = 0; i < 2; i++) {
        double sum = make_sensitivity(&f, s->b[i], p->pixels_per_degree);
        share[i] = s->a[i] * sqrt(M_PI / s->b[i]) * sum * sum;
        total += share[i];
    }
    for (int i = 0; i < 2; i++) {
        if (share[i] <= 0) continue;
        make_sensitivity(&f, s->b[i], p->pixels_per_degree);
        along_x(p, plane, wide, f);
        along_y(p, wide, result, f, (float)(share[i] / total), i > 0);
    }
    memcpy(plane, result, count * sizeof *plane);
}

bool flip_blur(const flip_planes *p, float *planes, float *scratch) {
    size_t count = (size_t)p->width * p->height;
    filter f;
    /* Three standard deviations of the widest: exp(−π² x²/b) has σ = √(b/(2 π²)). */
    if (!make_filter(&f, 3 * sqrt(0.04 / (2 * M_PI * M_PI)) * p->pixels_per_degree)) return false;
    for (size_t k = 0; k < 3; k++) blur_channel(p, &sensitivities[k], f, planes + k * count, scratch);
    free(f.taps);
    return true;
}

/* A Gaussian, and its first and second derivative: positive taps sum to 1 and negative ones to −1. */
static void make_derivative(filter *f, double sigma, int order) {
    double sums[2] = {0, 0};
    for (int turn = 0; turn < 2; turn++)
        for (int k = -f->radius; k <= f->radius; k++) {
            double g = exp(-(double)k * k / (2 * sigma * sigma));
            double v = order == 0 ? g : order == 1 ? -k * g : (k * k / (sigma * sigma) - 1) * g;
            if (turn) f->taps[k + f->radius] = (float)(v == 0 ? 0 : v / sums[v < 0]);
            else sums[v < 0] += fabs(v);
        }
}

static void detect(const flip_planes *p, const float *plane, filter smooth, filter slope, float *strength,
                   float *scratch) {
    size_t count = (size_t)p->width * p->height;
    float *wide = scratch, *across = scratch + count;
    along_x(p, plane, wide, slope);
    along_y(p, wide, across, smooth, 1, false);
    along_x(p, plane, wide, smooth);
    along_y(p, wide, strength, slope, 1, false);
    for (size_t i = 0; i < count; i++) strength[i] = sqrtf(across[i] * across[i] + strength[i] * strength[i]);
}

bool flip_detect(const flip_planes *p, const float *plane, flip_features features, float *scratch) {
    const double width_deg = 0.082; /* of a feature that eyes detect; section 4.2 */
    double sigma = 0.5 * width_deg * p->pixels_per_degree;
    filter smooth = {0}, slope = {0};
    bool done = make_filter(&smooth, 3 * sigma) && make_filter(&slope, 3 * sigma);
    if (done) {
        make_derivative(&smooth, sigma, 0);
        make_derivative(&slope, sigma, 1);
        detect(p, plane, smooth, slope, features.edges, scratch);
        make_derivative(&slope, sigma, 2);
        detect(p, plane, smooth, slope, features.points, scratch);
    }
    free(smooth.taps);
    free(slope.taps);
    return done;
}
