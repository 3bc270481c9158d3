/* Sampling against densities and values, for every row of bsdf_cases.c: what is drawn is what pdf says, multipliers are
 * value over pdf and hardly vary, and delta lobes are known to sample alone.
 *
 * All tests are joint at the level of one false alarm in a thousand (Šidák); seeds are fixed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/render/bsdf_chart.h"
#include "tests/render/statistics.h"

#define LEVEL 1e-3

/* The threshold of a mirror is at roughness 0.01; the last cosine is the least that shading normals leave. */
static const float roughnesses[] = {0, 0.0099f, 0.0101f, 0.05f, 0.25f, 0.6f, 1};
static const float cosines[] = {1, 0.6f, 0.1f, 0.01f};
enum { ROUGHNESSES = 7, COSINES = 4, SAMPLES = 4000 };

typedef struct setting {
    probe probe;
    const char *name;
    float roughness, cosine;
    double most_moment; /* 0: MOST_MOMENT */
    int samples;
    stream random;
} setting;

static int failures;
enum { FAILURES_MAX = 20 }; /* tell enough */

static void __attribute__((format(printf, 2, 3))) complain(const setting *s, const char *format, ...) {
    char text[256];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    failures++;
    print_error("%s, roughness %g, cos %g: %s\n", s->name, (double)s->roughness, (double)s->cosine, text);
}

/* What was tested, the least of the chi-square tests' p-values, and the largest relative second moment. */
typedef struct place { const char *name; float roughness, cosine; } place;
static struct { int chi_squares; double least_p, most_moment; place least_at, most_at; } grid = {.least_p = 1};

static place place_of(const setting *s) { return (place){s->name, s->roughness, s->cosine}; }

static void note_chi_square(const setting *s, double p) {
    grid.chi_squares++;
    if (p >= grid.least_p) return;
    grid.least_p = p;
    grid.least_at = place_of(s);
}

static void note_moment(const setting *s, double moment) {
    if (moment <= grid.most_moment) return;
    grid.most_moment = moment;
    grid.most_at = place_of(s);
}

static void print_grid(void) {
    double tests = (double)bsdf_case_count * ROUGHNESSES * COSINES;
    print_message("grid: %zu materials x up to %d roughnesses x %d cosines: %d chi-square tests of at least %d samples, "
                  "each at the level of %.3g, %g jointly\n", bsdf_case_count, ROUGHNESSES, COSINES, grid.chi_squares, SAMPLES,
                  sidak(LEVEL, tests), LEVEL);
    print_message("smallest p-value %.3g (%s, roughness %g, cos %g); the least of as many even ones has a mean of %.3g\n",
                  grid.least_p, grid.least_at.name, (double)grid.least_at.roughness, (double)grid.least_at.cosine,
                  1.0 / (grid.chi_squares + 1));
    print_message("largest E[m^2]/E[m]^2 of a multiplier %.3g (%s, roughness %g, cos %g)\n", grid.most_moment,
                  grid.most_at.name, (double)grid.most_at.roughness, (double)grid.most_at.cosine);
}

/* NULL: all. A mutant's lobe has a row that shows it. */
static const char *only;

static const char *row_of(const char *lobe) {
#define MATCH(id, text) if (!strcmp(lobe, #id)) return bsdf_case_of_##id;
    BSDF_LOBES(MATCH)
#undef MATCH
    return NULL;
}

static void for_each_setting(void (*check)(setting *, double tests)) {
    failures = 0;
    subject *subjects = calloc(1, sizeof *subjects);
    for (size_t c = 0; c < bsdf_case_count && failures < FAILURES_MAX; c++) {
        if (only && strcmp(only, bsdf_cases[c].name) != 0) continue;
        subject_make(subjects, &bsdf_cases[c]);
        for (int r = 0; r < (bsdf_cases[c].mask ? ROUGHNESSES : 1); r += SPARSE)
            for (int k = 0; k < COSINES; k++) {
                int samples = bsdf_cases[c].samples ? bsdf_cases[c].samples : SAMPLES;
                uint32_t seed = hash_triple((uint32_t)c, (uint32_t)r, (uint32_t)k);
                vec3 wo = direction_at((double)cosines[k], (double)unit_float(hash32(seed)));
                setting s = {probe_make(subjects, roughnesses[r], wo), bsdf_cases[c].name, roughnesses[r], cosines[k],
                             (double)bsdf_cases[c].most_moment, samples, {seed, 0}};
                check(&s, (double)bsdf_case_count * ROUGHNESSES * COSINES);
            }
    }
    free(subjects);
    assert_int_equal(failures, 0);
}

static float largest(vec3 v) { return fmaxf(fmaxf(v.x, v.y), v.z); }

static bsdf_sampled draw(const setting *s, stream *random) {
    float lobe = stream_next(random);
    return probe_sample(&s->probe, lobe, stream_pair(random));
}

/* No direction came of it: the microfacet sent it to the wrong side. */
static bool is_absorbed(const setting *s, const bsdf_sampled *r) {
    if (r->delta || largest(r->multiplier) > 0) return false;
    bool refracted = fabsf(v3_length(r->wi) - 1) < 1e-4f; /* there is no such direction under total reflection */
    return !(r->pdf > 0) || !refracted || largest(probe_evaluate(&s->probe, r->wi).value) > 0;
}

/* What midpoints and single precision leave of an integral: relative to 1 for probabilities, to the value for values. A
 * streak that is refracted close to the horizon is cut by it where few points lie; and few lie where narrow sheen does,
 * when half vectors chart it. */
#define QUADRATURE 6e-3
#define QUADRATURE_STREAK 1.5e-2

static double quadrature_error(const chart *c) {
    bool streak = c->refracts && c->stretch < 1, sheen = c->probe->mask & BSDF_SHEEN && c->probe->bsdf.p_sheen > 0;
    return streak || (sheen && !(c->sheen > 0)) ? QUADRATURE_STREAK : QUADRATURE;
}

/* A path's variance grows with E[m²]/E[m]² of its multipliers, in power: 1 where each is the mean, more where lobes are
 * chosen otherwise than what they return, or return it unevenly. At roughness 1, what misses the hemisphere makes 1.8.
 * What returns less than LEAST_POWER adds no noise that could be seen. */
#define MOST_MOMENT 2.0
#define LEAST_POWER 1e-3

static void check_moment(const setting *s, const tally *power, double squares) {
    if (!(power->mean > LEAST_POWER)) return;
    double moment = squares / s->samples / (power->mean * power->mean);
    double most = s->most_moment > 0 ? s->most_moment : MOST_MOMENT;
    note_moment(s, moment);
    if (!(moment < most)) complain(s, "E[m²]/E[m]² of the multiplier is %.2f, at most %.2f is expected", moment, most);
}

static void check_counts(setting *s, double tests) {
    chart c;
    chart_make(&c, &s->probe);
    chart_sums e = chart_integrate(&c);
    double off_chart = quadrature_error(&c);
    dvec3 sum = d3_add(e.value[0], e.value[1]);
    double integral[3] = {sum.x, sum.y, sum.z};
    double counts[CHART_CELLS + 1] = {0}, wanted[CHART_CELLS + 1], all = 0, squares = 0;
    tally means[3] = {{0}}, power = {0};
    for (int n = 0; n < s->samples; n++) {
        bsdf_sampled r = draw(s, &s->random);
        bool lost = !(r.pdf > 0) || is_absorbed(s, &r);
        counts[lost ? CHART_CELLS : chart_cell(&c, (dvec3){(double)r.wi.x, (double)r.wi.y, (double)r.wi.z})]++;
        double m = (double)average(r.multiplier) * (r.wi.z < 0 ? probe_squeeze(&s->probe) : 1);
        tally_add(&power, m);
        squares += m * m;
        tally_add(&means[0], r.pdf > 0 ? (double)r.multiplier.x : 0);
        tally_add(&means[1], r.pdf > 0 ? (double)r.multiplier.y : 0);
        tally_add(&means[2], r.pdf > 0 ? (double)r.multiplier.z : 0);
    }
    for (int i = 0; i < CHART_CELLS; i++) all += e.pdf[i], wanted[i] = s->samples * e.pdf[i];
    wanted[CHART_CELLS] = s->samples * fmax(1 - all, 0);
    double lost = counts[CHART_CELLS] / s->samples, error = sqrt(lost * (1 - lost) / s->samples) + 1e-9;
    if (normal_tail(fmax(fabs(lost - (1 - all)) - off_chart, 0) / error) < sidak(LEVEL, tests))
        complain(s, "pdf integrates to %.5f, and %.5f come to nothing", all, lost);
    double p = chi_square_p(counts, wanted, CHART_CELLS + 1);
    note_chi_square(s, p);
    if (p < sidak(LEVEL, tests)) complain(s, "sample does not follow pdf (p = %g)", p);
    check_moment(s, &power, squares);
    for (int k = 0; k < 3; k++) {
        /* Of events that are expected less than twenty times the samples tell no variance: they are Poisson's. */
        double least = sqrt(fmin(integral[k], 20.0 / s->samples) / s->samples), mean = means[k].mean;
        double off = fmax(fabs(mean - integral[k]) - off_chart * integral[k] - 1e-5, 0);
        if (normal_tail(off / fmax(tally_error(&means[k]), least + 1e-9)) < sidak(LEVEL, 3 * tests))
            complain(s, "the mean multiplier is %.5f ± %.5f, the integral %.5f", mean, tally_error(&means[k]), integral[k]);
    }
}

static void samples_follow_pdf(void **state) {
    (void)state;
    for_each_setting(check_counts);
    print_grid();
}

/* A lobe that bsdf_cases.c names no row for does not link. */
static void every_lobe_has_a_row(void **state) {
    (void)state;
#define NAME(id, text) bsdf_case_of_##id,
    const char *names[] = {BSDF_LOBES(NAME)};
#undef NAME
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        bool found = false;
        for (size_t c = 0; c < bsdf_case_count; c++) found = found || !strcmp(names[i], bsdf_cases[c].name);
        if (!found) fail_msg("there is no row '%s'", names[i]);
    }
}

/* The combined multiplier is value over density where there is a density. A delta lobe has none, and near its direction
 * evaluate and pdf say what they say elsewhere: without the lobe. */
static void check_one_by_one(setting *s, double tests) {
    (void)tests;
    for (int n = 0; n < 200; n++) {
        bsdf_sampled r = draw(s, &s->random);
        bsdf_value v = probe_evaluate(&s->probe, r.wi);
        if (r.delta && probe_narrowest(&s->probe) > 0.01f) {
            vec3 off = v3_scale(stream_direction(&s->random), 1e-4f * fabsf(r.wi.z));
            bsdf_value beside = probe_evaluate(&s->probe, v3_normalize(v3_add(r.wi, off)));
            float difference = largest(v3_abs(v3_sub(v.value, beside.value)));
            if (r.pdf != 0 || difference > 2e-3f * largest(v.value) || fabsf(v.pdf - beside.pdf) > 2e-3f * v.pdf)
                complain(s, "evaluate knows a delta: value %g, %g beside it; pdf %g, %g", (double)largest(v.value),
                         (double)largest(beside.value), (double)v.pdf, (double)beside.pdf);
        } else if (r.pdf > 0 && !is_absorbed(s, &r)) {
            float off = largest(v3_abs(v3_sub(v3_scale(r.multiplier, r.pdf), v.value)));
            if (v.pdf != r.pdf || !(v.pdf > 0) || off > 1e-6f * largest(v.value))
                complain(s, "multiplier · pdf misses the value by %g of %g; pdf %g, %g", (double)off,
                         (double)largest(v.value), (double)r.pdf, (double)v.pdf);
        }
        if (!is_absorbed(s, &r) && fabsf(v3_length(r.wi) - 1) > 1e-5f)
            complain(s, "a direction of length %.7f", (double)v3_length(r.wi));
    }
}

static void multipliers_are_value_over_pdf(void **state) {
    (void)state;
    for_each_setting(check_one_by_one);
}

/* f cos/pdf with directions uniform on the sphere expects what the combined multiplier does. Narrow lobes are left out:
 * hardly a direction would meet them. */
static void check_naive_form(setting *s, double tests) {
    if (probe_narrowest(&s->probe) < 0.25f) return;
    tally naive = {0}, combined = {0};
    for (int n = 0; n < SAMPLES; n++) {
        bsdf_sampled r = draw(s, &s->random);
        bsdf_value v = probe_evaluate(&s->probe, stream_direction(&s->random));
        tally_add(&combined, r.pdf > 0 ? (double)average(r.multiplier) : 0);
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

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_lobe_has_a_row),
        cmocka_unit_test(samples_follow_pdf),
        cmocka_unit_test(multipliers_are_value_over_pdf),
        cmocka_unit_test(naive_form_expects_the_same),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them, and their lobe */
    if (argc > 2) only = row_of(argv[2]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
