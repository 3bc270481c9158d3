/* Sampling against densities and values, for every row of bsdf_cases.c: what is drawn is what pdf says, multipliers are
 * value over pdf, and delta lobes are known to sample alone.
 *
 * All tests are joint at the level of one false alarm in a thousand (Šidák); seeds are fixed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/mat.h"

#include "tests/render/bsdf_cases.h"
#include "tests/render/statistics.h"

#define LEVEL 1e-3

/* The threshold of a mirror is at roughness 0.01; the last cosine is the least that shading normals leave. */
static const float roughnesses[] = {0, 0.0099f, 0.0101f, 0.05f, 0.25f, 0.6f, 1};
static const float cosines[] = {1, 0.6f, 0.1f, 0.01f};
enum { ROUGHNESSES = 7, COSINES = 4 };

typedef struct setting {
    probe probe;
    const char *name;
    float roughness, cosine;
    stream random;
} setting;

static int failures;

static void __attribute__((format(printf, 2, 3))) complain(const setting *s, const char *format, ...) {
    char text[256];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (failures++ < 20)
        print_error("%s, roughness %g, cos %g: %s\n", s->name, (double)s->roughness, (double)s->cosine, text);
}

static void for_each_setting(void (*check)(setting *, double tests)) {
    failures = 0;
    subject *subjects = calloc(1, sizeof *subjects);
    for (size_t c = 0; c < bsdf_case_count; c++) {
        subject_make(subjects, &bsdf_cases[c]);
        for (int r = 0; r < (bsdf_cases[c].mask ? ROUGHNESSES : 1); r++)
            for (int k = 0; k < COSINES; k++) {
                uint32_t seed = hash_triple((uint32_t)c, (uint32_t)r, (uint32_t)k);
                vec3 wo = direction_at((double)cosines[k], (double)unit_float(hash32(seed)));
                setting s = {probe_make(subjects, roughnesses[r], wo), bsdf_cases[c].name, roughnesses[r], cosines[k],
                             {seed, 0}};
                check(&s, (double)bsdf_case_count * ROUGHNESSES * COSINES);
            }
    }
    free(subjects);
    assert_int_equal(failures, 0);
}

/* Directions are counted by their half vectors, which resolve a microfacet lobe of any width. With x = tan² of the half
 * vector's angle, GGX spreads evenly over x/(α² + x); a third of the rings are spaced so, the others for wide lobes and
 * for what grazes. */
enum { RINGS = 9, SECTORS = 8, FINE = 100, ROWS = RINGS * FINE, SIDE = RINGS * SECTORS, BEYOND = 2 * SIDE, CELLS };
#define WIDE2 0.25
#define GRAZING2 20.0

typedef struct chart {
    const probe *probe;
    double a2; /* α² */
    dvec3 wo;
    bool refracts; /* below, half vectors are those of refraction */
    double x[ROWS]; /* in the middle of every hundredth of a ring */
} chart;

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

static void chart_make(chart *c, const probe *p) {
    bool solid = p->mask & BSDF_TRANSMISSIVE && p->bsdf.thin < 0.5f, refracts = solid && !bsdf_is_straight(&p->bsdf);
    bool glossy = p->mask && (refracts || !bsdf_is_mirror(p->bsdf.alpha));
    double alpha = glossy ? fmax((double)p->bsdf.alpha, (double)GGX_ALPHA_MIN) : 0.3;
    *c = (chart){.probe = p, .a2 = alpha * alpha, .wo = to_double(p->bsdf.wo), .refracts = refracts};
    for (int row = 0; row < ROWS; row++) c->x[row] = tan2_of(c, (row + 0.5) / ROWS);
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

static int cell_of(const chart *c, dvec3 wi) {
    int below = wi.z < 0;
    dvec3 h = d3_add(c->wo, (dvec3){wi.x, wi.y, fabs(wi.z)});
    if (below && c->probe->bsdf.thin < 0.5f) {
        h = d3_add(c->wo, d3_scale(wi, (double)c->probe->bsdf.eta));
        if (h.z < 0) h = d3_scale(h, -1);
        if (!c->refracts || !(d3_dot(c->wo, h) > 0 && d3_dot(wi, h) < 0)) return BEYOND;
    }
    double turn = atan2(h.y, h.x) / (2 * M_PI);
    int ring = (int)(RINGS * ring_of(c, (h.x * h.x + h.y * h.y) / (h.z * h.z)));
    int sector = (int)(SECTORS * (turn - floor(turn)));
    ring = ring < RINGS ? ring : RINGS - 1;
    return below * SIDE + ring * SECTORS + (sector < SECTORS ? sector : SECTORS - 1);
}

/* What pdf and evaluate say of each cell, by midpoints. */
typedef struct expectation { double pdf[CELLS], value[3]; } expectation;

static void add(expectation *e, const chart *c, int cell, dvec3 wi, double weight) {
    bsdf_value v = probe_evaluate(c->probe, to_single(wi));
    e->pdf[cell] += weight * (double)v.pdf;
    e->value[0] += weight * (double)v.value.x;
    e->value[1] += weight * (double)v.value.y;
    e->value[2] += weight * (double)v.value.z;
}

/* A lattice: its rows are staggered, for the horizon often runs along a ring. */
static void add_by_half_vectors(expectation *e, const chart *c, int below) {
    for (int row = 0; row < ROWS; row++) {
        double x = c->x[row], z = 1 / sqrt(1 + x), r = sqrt(x) * z;
        double angle = 0.5 * z * z * z / ring_slope(c, x) * 2 * M_PI / (ROWS * SECTORS); /* that the half vector stands for */
        for (int sector = 0; sector < SECTORS; sector++) {
            double stretch, phi = 2 * M_PI * (sector + (row * 7 % 10 + 0.5) / 10) / SECTORS;
            dvec3 wi, h = {r * cos(phi), r * sin(phi), z};
            if (follow(c, h, below, &wi, &stretch))
                add(e, c, below * SIDE + row / FINE * SECTORS + sector, wi, angle * stretch);
        }
    }
}

/* Directions below that no half vector leads to. */
static void add_beyond(expectation *e, const chart *c) {
    enum { N = 64 };
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double z = sqrt((i + 0.5) / N), r = sqrt(1 - z * z), phi = 2 * M_PI * (j + 0.5) / N;
            dvec3 wi = {r * cos(phi), r * sin(phi), -z};
            if (cell_of(c, wi) == BEYOND) add(e, c, BEYOND, wi, M_PI / z / (N * N));
        }
}

static expectation expect(const chart *c) {
    expectation e = {0};
    bool transmissive = c->probe->mask & BSDF_TRANSMISSIVE, thin = c->probe->bsdf.thin > 0.5f;
    add_by_half_vectors(&e, c, 0);
    if (transmissive && (thin || c->refracts)) add_by_half_vectors(&e, c, 1);
    if (transmissive && !thin) add_beyond(&e, c);
    return e;
}

static float largest(vec3 v) { return fmaxf(fmaxf(v.x, v.y), v.z); }

static bsdf_sampled draw(const setting *s, stream *random) {
    float lobe = stream_next(random);
    return probe_sample(&s->probe, lobe, stream_pair(random));
}

/* No direction came of it: the microfacet sent it to the wrong side. */
static bool is_absorbed(const setting *s, const bsdf_sampled *r) {
    if (r->delta || largest(r->multiplier) > 0) return false;
    return !(r->pdf > 0) || largest(probe_evaluate(&s->probe, r->wi).value) > 0;
}

enum { SAMPLES = 4000 };
/* What midpoints and single precision leave of an integral: relative to 1 for probabilities, to the value for values. */
#define QUADRATURE 3e-3

static void check_counts(setting *s, double tests) {
    chart c;
    chart_make(&c, &s->probe);
    expectation e = expect(&c);
    double counts[CELLS + 1] = {0}, wanted[CELLS + 1], all = 0;
    tally means[3] = {{0}};
    for (int n = 0; n < SAMPLES; n++) {
        bsdf_sampled r = draw(s, &s->random);
        bool lost = r.delta || is_absorbed(s, &r);
        counts[lost ? CELLS : cell_of(&c, to_double(r.wi))]++;
        tally_add(&means[0], r.delta ? 0 : (double)r.multiplier.x);
        tally_add(&means[1], r.delta ? 0 : (double)r.multiplier.y);
        tally_add(&means[2], r.delta ? 0 : (double)r.multiplier.z);
    }
    for (int i = 0; i < CELLS; i++) all += e.pdf[i], wanted[i] = SAMPLES * e.pdf[i];
    wanted[CELLS] = SAMPLES * fmax(1 - all, 0);
    double lost = counts[CELLS] / SAMPLES, error = sqrt(lost * (1 - lost) / SAMPLES) + 1e-9;
    if (normal_tail(fmax(fabs(lost - (1 - all)) - QUADRATURE, 0) / error) < sidak(LEVEL, tests))
        complain(s, "pdf integrates to %.5f, and %.5f come to nothing", all, lost);
    double p = chi_square_p(counts, wanted, CELLS + 1);
    if (p < sidak(LEVEL, tests)) complain(s, "sample does not follow pdf (p = %g)", p);
    for (int k = 0; k < 3; k++) {
        /* Of events that are expected less than twenty times the samples tell no variance: they are Poisson's. */
        double least = sqrt(fmin(e.value[k], 20.0 / SAMPLES) / SAMPLES), mean = means[k].mean;
        double off = fmax(fabs(mean - e.value[k]) - QUADRATURE * e.value[k] - 1e-5, 0);
        if (normal_tail(off / fmax(tally_error(&means[k]), least + 1e-9)) < sidak(LEVEL, 3 * tests))
            complain(s, "the mean multiplier is %.5f ± %.5f, the integral %.5f", mean, tally_error(&means[k]), e.value[k]);
    }
}

static void samples_follow_pdf(void **state) {
    (void)state;
    for_each_setting(check_counts);
}

/* The combined multiplier is value over density where there is a density. A delta lobe has none, and near its direction
 * evaluate and pdf say what they say elsewhere: without the lobe. */
static void check_one_by_one(setting *s, double tests) {
    (void)tests;
    for (int n = 0; n < 200; n++) {
        bsdf_sampled r = draw(s, &s->random);
        bsdf_value v = probe_evaluate(&s->probe, r.wi);
        if (r.delta) {
            vec3 off = v3_scale(stream_direction(&s->random), 1e-4f * fabsf(r.wi.z));
            bsdf_value beside = probe_evaluate(&s->probe, v3_normalize(v3_add(r.wi, off)));
            float difference = largest(v3_abs(v3_sub(v.value, beside.value)));
            if (r.pdf != 0 || difference > 2e-3f * largest(v.value) || fabsf(v.pdf - beside.pdf) > 2e-3f * v.pdf)
                complain(s, "evaluate knows a delta: value %g, %g beside it; pdf %g, %g", (double)largest(v.value),
                         (double)largest(beside.value), (double)v.pdf, (double)beside.pdf);
        } else if (!is_absorbed(s, &r)) {
            float off = largest(v3_abs(v3_sub(v3_scale(r.multiplier, r.pdf), v.value)));
            if (v.pdf != r.pdf || !(v.pdf > 0) || off > 1e-6f * largest(v.value))
                complain(s, "multiplier · pdf misses the value by %g of %g; pdf %g, %g", (double)off,
                         (double)largest(v.value), (double)r.pdf, (double)v.pdf);
        }
        if (!is_absorbed(s, &r) && fabsf(v3_length(r.wi) - 1) > 1e-5f) complain(s, "a direction of length %.7f", (double)v3_length(r.wi));
    }
}

static void multipliers_are_value_over_pdf(void **state) {
    (void)state;
    for_each_setting(check_one_by_one);
}

/* f cos/pdf with directions uniform on the sphere expects what the combined multiplier does. Narrow lobes are left out:
 * hardly a direction would meet them. */
static void check_naive_form(setting *s, double tests) {
    if (s->probe.mask && s->roughness < 0.5f) return;
    tally naive = {0}, combined = {0};
    for (int n = 0; n < SAMPLES; n++) {
        bsdf_sampled r = draw(s, &s->random);
        bsdf_value v = probe_evaluate(&s->probe, stream_direction(&s->random));
        tally_add(&combined, r.delta ? 0 : (double)average(r.multiplier));
        tally_add(&naive, 4 * M_PI * (double)average(v.value));
    }
    double error = hypot(tally_error(&naive), tally_error(&combined)) + 1e-12;
    if (normal_tail((naive.mean - combined.mean) / error) < sidak(LEVEL, tests))
        complain(s, "naive form %.5f, multiplier %.5f, error of the difference %.5f", naive.mean, combined.mean, error);
}

static void naive_form_expects_the_same(void **state) {
    (void)state;
    for_each_setting(check_naive_form);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_follow_pdf),
        cmocka_unit_test(multipliers_are_value_over_pdf),
        cmocka_unit_test(naive_form_expects_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
