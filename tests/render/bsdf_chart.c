#include "tests/render/bsdf_chart.h"

#include <math.h>

#define WIDE2 0.25
#define GRAZING2 20.0

static dvec3 to_double(vec3 v) { return (dvec3){(double)v.x, (double)v.y, (double)v.z}; }
static vec3 to_single(dvec3 v) { return v3((float)v.x, (float)v.y, (float)v.z); }

static double ring_of(const chart *c, double x) {
    return (x / (c->a2 + x) + x / (WIDE2 + x) + x / (GRAZING2 + x)) / 3;
}
static double bell(double width2, double x) { return width2 / ((width2 + x) * (width2 + x)); }
static double ring_slope(const chart *c, double x) { return (bell(c->a2, x) + bell(WIDE2, x) + bell(GRAZING2, x)) / 3; }

static double tan2_of(const chart *c, double ring) {
    double low = 1e-14, high = 1e8; /* bisected by their geometric means */
    for (int i = 0; i < 34; i++) {
        double middle = sqrt(low * high);
        *(ring_of(c, middle) < ring ? &low : &high) = middle;
    }
    return low;
}

void chart_make(chart *c, const probe *p) {
    bool solid = p->mask & BSDF_TRANSMISSIVE && p->bsdf.thin < 0.5f, refracts = solid && !bsdf_is_straight(&p->bsdf);
    bool glossy = p->mask && (refracts || !bsdf_is_mirror(p->bsdf.alpha));
    double alpha = glossy ? fmax((double)p->bsdf.alpha, (double)GGX_ALPHA_MIN) : 0.3;
    *c = (chart){.probe = p, .a2 = alpha * alpha, .wo = to_double(p->bsdf.wo), .refracts = refracts};
    for (int row = 0; row < CHART_ROWS; row++) c->x[row] = tan2_of(c, (row + 0.5) / CHART_ROWS);
}

/* The direction that the half vector leads to, above (0) or below (1), and the solid angle that it sweeps for each of the
 * half vector's; false: none. */
static bool follow(const chart *c, dvec3 h, int below, dvec3 *wi, double *stretch) {
    double co = d3_dot(c->wo, h), eta = (double)c->probe->bsdf.eta;
    if (!(co > 0)) return false;
    if (below && c->refracts) {
        double k = 1 - (1 - co * co) / (eta * eta), t = sqrt(fmax(k, 0));
        *wi = d3_sub(d3_scale(h, co / eta - t), d3_scale(c->wo, 1 / eta));
        *stretch = t > 0 ? pow(co - eta * t, 2) / (eta * eta * t) : 0; /* Walter et al. 2007, eq. 17: wi·h = −t */
        return k > 0 && wi->z < 0;
    }
    *wi = d3_sub(d3_scale(h, 2 * co), c->wo);
    *stretch = 4 * co;
    if (!(wi->z > 0)) return false;
    if (below) wi->z = -wi->z;
    return true;
}

int chart_cell(const chart *c, dvec3 wi) {
    int below = wi.z < 0;
    dvec3 h = d3_add(c->wo, (dvec3){wi.x, wi.y, fabs(wi.z)});
    if (below && c->probe->bsdf.thin < 0.5f) {
        h = d3_add(c->wo, d3_scale(wi, (double)c->probe->bsdf.eta));
        if (h.z < 0) h = d3_scale(h, -1);
        if (!c->refracts || !(d3_dot(c->wo, h) > 0 && d3_dot(wi, h) < 0)) return CHART_BEYOND;
    }
    double turn = atan2(h.y, h.x) / (2 * M_PI);
    int ring = (int)(CHART_RINGS * ring_of(c, (h.x * h.x + h.y * h.y) / (h.z * h.z)));
    int sector = (int)(CHART_SECTORS * (turn - floor(turn)));
    ring = ring < CHART_RINGS ? ring : CHART_RINGS - 1;
    return below * CHART_SIDE + ring * CHART_SECTORS + (sector < CHART_SECTORS ? sector : CHART_SECTORS - 1);
}

static void add(chart_sums *s, const chart *c, int cell, dvec3 wi, double weight) {
    bsdf_value v = probe_evaluate(c->probe, to_single(wi));
    dvec3 *sum = &s->value[wi.z < 0];
    s->pdf[cell] += weight * (double)v.pdf;
    *sum = d3_add(*sum, d3_scale(to_double(v.value), weight));
}

/* A lattice: its rows are staggered, for the horizon often runs along a ring. */
static void add_by_half_vectors(chart_sums *s, const chart *c, int below) {
    for (int row = 0; row < CHART_ROWS; row++) {
        double x = c->x[row], z = 1 / sqrt(1 + x), r = sqrt(x) * z;
        /* The solid angle that one half vector stands for. */
        double angle = 0.5 * z * z * z / ring_slope(c, x) * 2 * M_PI / (CHART_ROWS * CHART_SECTORS);
        for (int sector = 0; sector < CHART_SECTORS; sector++) {
            double stretch, phi = 2 * M_PI * (sector + (row * 7 % 10 + 0.5) / 10) / CHART_SECTORS;
            dvec3 wi, h = {r * cos(phi), r * sin(phi), z};
            if (follow(c, h, below, &wi, &stretch))
                add(s, c, below * CHART_SIDE + row / CHART_FINE * CHART_SECTORS + sector, wi, angle * stretch);
        }
    }
}

/* Directions below that no half vector leads to. */
static void add_beyond(chart_sums *s, const chart *c) {
    enum { N = 64 };
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double z = sqrt((i + 0.5) / N), r = sqrt(1 - z * z), phi = 2 * M_PI * (j + 0.5) / N;
            dvec3 wi = {r * cos(phi), r * sin(phi), -z};
            if (chart_cell(c, wi) == CHART_BEYOND) add(s, c, CHART_BEYOND, wi, M_PI / z / (N * N));
        }
}

chart_sums chart_integrate(const chart *c) {
    chart_sums s = {0};
    bool transmissive = c->probe->mask & BSDF_TRANSMISSIVE, thin = c->probe->bsdf.thin > 0.5f;
    add_by_half_vectors(&s, c, 0);
    if (transmissive && (thin || c->refracts)) add_by_half_vectors(&s, c, 1);
    if (transmissive && !thin) add_beyond(&s, c);
    return s;
}
