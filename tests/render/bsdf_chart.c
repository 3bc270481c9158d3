#include "tests/render/bsdf_chart.h"

#include <math.h>

#define WIDE2 0.25
#define GRAZING2 20.0

static dvec3 to_double(vec3 v) { return (dvec3){(double)v.x, (double)v.y, (double)v.z}; }
static vec3 to_single(dvec3 v) { return v3((float)v.x, (float)v.y, (float)v.z); }

static double ring_of(const chart *c, double x) {
    double sum = 0;
    for (int k = 0; k < c->width_count; k++) sum += x / (c->widths[k] + x) / c->width_count;
    return sum;
}
static double ring_slope(const chart *c, double x) {
    double sum = 0;
    for (int k = 0; k < c->width_count; k++) sum += c->widths[k] / pow(c->widths[k] + x, 2) / c->width_count;
    return sum;
}

static double tan2_of(const chart *c, double ring) {
    double low = 1e-14, high = 1e8; /* bisected by their geometric means */
    for (int i = 0; i < 34; i++) {
        double middle = sqrt(low * high);
        *(ring_of(c, middle) < ring ? &low : &high) = middle;
    }
    return low;
}

void chart_make(chart *c, const probe *p) {
    bool solid = p->mask & BSDF_TRANSMISSIVE && p->bsdf.thin < 0.5f, interface = p->bsdf.interface > 0, refracts = solid && interface && !bsdf_is_straight(&p->bsdf);
    bool glossy = p->mask && (refracts || !bsdf_is_mirror(p->bsdf.alphas.x));
    double least = (double)GGX_ALPHA_MIN, alpha = glossy ? fmax((double)p->bsdf.alphas.x, least) : 0.3;
    double y = glossy ? fmax((double)p->bsdf.alphas.y, least) : alpha;
    *c = (chart){.probe = p, .a2 = alpha * alpha, .stretch = y / alpha, .wo = to_double(p->bsdf.wo), .refracts = refracts, .mirrors = !solid || !interface,
                 .widths = {alpha * alpha, WIDE2, GRAZING2}, .width_count = 3};
    if (p->mask & BSDF_SHEEN && p->bsdf.p_sheen > 0 && p->bsdf.p_glossy == 0 && p->bsdf.p_clearcoat == 0)
        c->sheen = (double)(SHEEN_SPREAD * p->bsdf.sheen.roughness);
    float coat = p->bsdf.clearcoat.alpha;
    if (p->mask & BSDF_CLEARCOAT && p->bsdf.clearcoat.near > 0 && !bsdf_is_mirror(coat))
        c->widths[c->width_count++] = (double)coat * (double)coat;
    double horizon2 = 1 / (c->wo.z * c->wo.z + (double)p->bsdf.grazing.k2);
    if (p->mask && p->bsdf.p_grazing + p->bsdf.p_grazing_below > 0 && horizon2 > GRAZING2)
        c->widths[c->width_count++] = horizon2;
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

static int cell_at(double ring, double turn) {
    int i = (int)(CHART_RINGS * ring), j = (int)(CHART_SECTORS * (turn - floor(turn)));
    i = i < CHART_RINGS ? i : CHART_RINGS - 1;
    return i * CHART_SECTORS + (j < CHART_SECTORS ? j : CHART_SECTORS - 1);
}
static int elevation_cell(const chart *c, dvec3 wi) {
    double z = fabs(wi.z);
    return (wi.z < 0) * CHART_SIDE + cell_at(z * (1 + c->sheen) / (z + c->sheen), atan2(wi.y, wi.x) / (2 * M_PI));
}

int chart_cell(const chart *c, dvec3 wi) {
    int below = wi.z < 0;
    if (c->sheen > 0) return elevation_cell(c, wi);
    dvec3 h = d3_add(c->wo, (dvec3){wi.x, wi.y, fabs(wi.z)});
    if (below && !c->mirrors) {
        h = d3_add(c->wo, d3_scale(wi, (double)c->probe->bsdf.eta));
        if (h.z < 0) h = d3_scale(h, -1);
        if (!c->refracts || !(d3_dot(c->wo, h) > 0 && d3_dot(wi, h) < 0)) return CHART_BEYOND;
    }
    double y = h.y / c->stretch, turn = atan2(y, h.x) / (2 * M_PI);
    return below * CHART_SIDE + cell_at(ring_of(c, (h.x * h.x + y * y) / (h.z * h.z)), turn);
}

static void add(chart_sums *s, const chart *c, int cell, dvec3 wi, double weight) {
    bsdf_value v = probe_evaluate(c->probe, to_single(wi));
    dvec3 *sum = &s->value[wi.z < 0];
    s->pdf[cell] += weight * (double)v.pdf;
    *sum = d3_add(*sum, d3_scale(to_double(v.value), weight));
}

/* How many half vectors of a lattice there are to an area of the plane z = 1, where y is stretched. */
static double lattice_density(const chart *c, double x, double y, double stretch) {
    double v = y / stretch;
    return ring_slope(c, x * x + v * v) * CHART_ROWS * CHART_SECTORS / (M_PI * stretch);
}

/* A lattice: its rows are staggered, for the horizon often runs along a ring. */
static void add_lattice(chart_sums *s, const chart *c, int below, double stretch) {
    for (int row = 0; row < CHART_ROWS; row++) {
        double r = sqrt(c->x[row]);
        for (int sector = 0; sector < CHART_SECTORS; sector++) {
            double sweep, phi = 2 * M_PI * (sector + (row * 7 % 10 + 0.5) / 10) / CHART_SECTORS;
            dvec3 wi, h = {r * cos(phi), r * sin(phi) * stretch, 1};
            double z = 1 / sqrt(d3_dot(h, h)), density = lattice_density(c, h.x, h.y, c->stretch);
            if (c->stretch != 1) density += lattice_density(c, h.x, h.y, 1);
            if (follow(c, d3_scale(h, z), below, &wi, &sweep)) add(s, c, chart_cell(c, wi), wi, z * z * z * sweep / density);
        }
    }
}
static void add_by_half_vectors(chart_sums *s, const chart *c, int below) {
    add_lattice(s, c, below, c->stretch);
    if (c->stretch != 1) add_lattice(s, c, below, 1);
}

static void add_by_elevations(chart_sums *s, const chart *c) {
    for (int row = 0; row < CHART_ROWS; row++) {
        double u = (row + 0.5) / CHART_ROWS, d = 1 + c->sheen - u, z = c->sheen * u / d, r = sqrt(1 - z * z);
        double angle = c->sheen * (1 + c->sheen) / (d * d) * 2 * M_PI / (CHART_ROWS * CHART_SECTORS * 4);
        for (int k = 0; k < CHART_SECTORS * 4; k++) {
            double phi = 2 * M_PI * (k + (row * 7 % 10 + 0.5) / 10) / (CHART_SECTORS * 4);
            dvec3 up = {r * cos(phi), r * sin(phi), z}, down = {up.x, up.y, -z};
            add(s, c, chart_cell(c, up), up, angle);
            if (c->probe->mask & BSDF_TRANSMISSIVE) add(s, c, chart_cell(c, down), down, angle);
        }
    }
}

/* z of a row, where half of the rows are as dense as GRAZING is and half as a cosine. */
static double beyond_z(const chart *c, double row) {
    double k2 = (double)c->probe->bsdf.grazing.k2, low = 0, high = 1;
    for (int i = 0; i < 40; i++) {
        double z2 = pow(0.5 * (low + high), 2), at = 0.5 * z2 + 0.5 * log1p(z2 / k2) / log1p(1 / k2);
        *(at < row ? &low : &high) = 0.5 * (low + high);
    }
    return low;
}

/* Directions below that no half vector leads to. */
static void add_beyond(chart_sums *s, const chart *c) {
    enum { ROWS = 128, SECTORS = 64 };
    for (int i = 0; i < ROWS; i++) {
        double z = beyond_z(c, (i + 0.5) / ROWS), r = sqrt(1 - z * z);
        double angle = (beyond_z(c, (i + 1.0) / ROWS) - beyond_z(c, (double)i / ROWS)) * 2 * M_PI / SECTORS;
        for (int j = 0; j < SECTORS; j++) {
            double phi = 2 * M_PI * (j + 0.5) / SECTORS;
            dvec3 wi = {r * cos(phi), r * sin(phi), -z};
            if (chart_cell(c, wi) == CHART_BEYOND) add(s, c, CHART_BEYOND, wi, angle);
        }
    }
}

chart_sums chart_integrate(const chart *c) {
    chart_sums s = {0};
    if (c->sheen > 0) {
        add_by_elevations(&s, c);
        return s;
    }
    bool transmissive = c->probe->mask & BSDF_TRANSMISSIVE;
    add_by_half_vectors(&s, c, 0);
    if (transmissive && (c->mirrors || c->refracts)) add_by_half_vectors(&s, c, 1);
    if (transmissive && !c->mirrors) add_beyond(&s, c);
    return s;
}
