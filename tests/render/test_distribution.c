/* Discrete distributions: what is drawn and what is computed agree exactly, quantum by quantum. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include <math.h>

#include "render/light/distribution.h"
#include "tests/render/statistics.h"

typedef struct table {
    uint32_t count;
    float *weights;
    uint32_t *cdf, *guide;
} table;

static table table_make(uint32_t count, float (*weight)(uint32_t i, uint32_t count)) {
    table t = {count, calloc(count, sizeof *t.weights), calloc(count + 1, sizeof *t.cdf), calloc(count, sizeof *t.guide)};
    for (uint32_t i = 0; i < count; i++) t.weights[i] = weight(i, count);
    distribution_build(t.weights, count, t.cdf, t.guide);
    return t;
}
static void table_free(table *t) {
    free(t->weights);
    free(t->cdf);
    free(t->guide);
}

static float equal(uint32_t i, uint32_t n) { return (void)i, (void)n, 3.5f; }
static float ramp(uint32_t i, uint32_t n) { return (void)n, (float)i; }
static float random_weight(uint32_t i, uint32_t n) { return (void)n, unit_float(hash32(i)); }
static float sparse(uint32_t i, uint32_t n) { return (void)n, i % 7 == 3 ? unit_float(hash32(i)) : 0; }
static float first_only(uint32_t i, uint32_t n) { return (void)n, i == 0; }
static float last_only(uint32_t i, uint32_t n) { return i + 1 == n; }
static float extremes(uint32_t i, uint32_t n) { return (void)n, i & 1 ? 1e30f : 1e-30f; }
static float one_huge(uint32_t i, uint32_t n) { return i == n / 3 ? 1e30f : 1e-30f; }
static float denormal(uint32_t i, uint32_t n) { return (void)n, (float)(i + 1) * 0x1p-149f; }
static float largest_floats(uint32_t i, uint32_t n) { return (void)i, (void)n, 3.4e38f; }
static float lamps(uint32_t i, uint32_t n) { return (void)n, i % 50000 == 7 ? 1e6f : 1e-6f; }
static float spread(uint32_t i, uint32_t n) { return exp2f(-60 * (float)i / (float)n); }

typedef struct row { const char *name; uint32_t count; float (*weight)(uint32_t, uint32_t); } row;

static const row rows[] = {
    {"one", 1, equal}, {"two", 2, random_weight}, {"three equal", 3, equal}, {"ramp", 100, ramp},
    {"random", 1000, random_weight}, {"sparse", 1000, sparse}, {"first", 17, first_only}, {"last", 17, last_only},
    {"extremes", 10, extremes}, {"one huge", 1000, one_huge}, {"denormal", 5, denormal},
    {"largest floats", 100, largest_floats}, {"spread", 300, spread},
    {"a million", 1 << 20, random_weight}, {"a million and one huge", 1000003, one_huge},
    {"twenty lamps in a million", 1000000, lamps}, {"five million equal", 5000000, equal}, {"eight million", 1 << 23, equal}, {"sparse million", 1 << 20, sparse},
};
enum { ROWS = sizeof rows / sizeof *rows };

/* Each slot of the guide table begins with the outcome of its first quantum. */
static void check_guide(const char *name, const table *t) {
    for (uint32_t slot = 0; slot < t->count; slot++) {
        uint64_t first = (((uint64_t)slot << 24) + t->count - 1) / t->count;
        uint32_t at = t->guide[slot];
        if (!(t->cdf[at] <= first && first < t->cdf[at + 1])) fail_msg("%s: slot %u begins with %u", name, slot, at);
    }
}

/* Probabilities are whole quanta, sum to 1 exactly, never 0 for a positive weight and always for none. They are within a
 * quantum of the weights' shares, but that outcomes of less than a quantum get one, at the others' cost. */
static void probabilities_are_exact(void **state) {
    (void)state;
    for (int r = 0; r < ROWS; r++) {
        table t = table_make(rows[r].count, rows[r].weight);
        double sum = 0, total = 0, worst = 0, raised = 0;
        for (uint32_t i = 0; i < t.count; i++) total += (double)t.weights[i];
        for (uint32_t i = 0; i < t.count; i++)
            raised += t.weights[i] > 0 ? fmax(0x1p-24 - (double)t.weights[i] / total, 0) : 0;
        for (uint32_t i = 0; i < t.count; i++) {
            double p = (double)distribution_probability(t.cdf, i), share = (double)t.weights[i] / total;
            if ((p > 0) != (t.weights[i] > 0))
                fail_msg("%s: weight %g of %u has probability %g", rows[r].name, (double)t.weights[i], i, p);
            sum += p;
            worst = fmax(worst, fabs(p - share) - raised * share);
        }
        if (sum != 1) fail_msg("%s: probabilities sum to %.17g", rows[r].name, sum);
        if (worst > 1.01 * 0x1p-24) fail_msg("%s: a probability is %g off", rows[r].name, worst);
        check_guide(rows[r].name, &t);
        assert_int_equal(t.cdf[0], 0);
        assert_int_equal(t.cdf[t.count], DISTRIBUTION_QUANTA);
        table_free(&t);
    }
}

/* Every quantum of small tables, some of large ones: the outcome is the one whose range it lies in, so that each is drawn
 * as often as its probability says; rest is the place within. */
static void picks_match_probabilities(void **state) {
    (void)state;
    for (int r = 0; r < ROWS; r++) {
        table t = table_make(rows[r].count, rows[r].weight);
        uint32_t step = r < 4 ? 1 : 251, index = 0, bad = 0;
        for (uint32_t quantum = 0; quantum < DISTRIBUTION_QUANTA; quantum += step) {
            while (t.cdf[index + 1] <= quantum) index++;
            float rest, place = ((float)(quantum - t.cdf[index]) + 0.25f) / (float)(t.cdf[index + 1] - t.cdf[index]);
            uint32_t picked = distribution_pick(t.cdf, t.guide, t.count, (float)quantum * 0x1p-24f, 0.25f, &rest);
            bad += picked != index || rest != place || !(t.weights[picked] > 0);
        }
        if (bad) fail_msg("%s: %u quanta lead astray", rows[r].name, bad);
        table_free(&t);
    }
}

/* rest stays in [0, 1) and is uniform: chi-square at 1e-3. */
static void rests_are_uniform(void **state) {
    (void)state;
    enum { CELLS = 64, DRAWS = 200000 };
    table t = table_make(1000, random_weight);
    double counts[CELLS] = {0}, expected[CELLS];
    stream random = {5, 0};
    for (int i = 0; i < DRAWS; i++) {
        float rest, u = stream_next(&random);
        distribution_pick(t.cdf, t.guide, t.count, u, stream_next(&random), &rest);
        assert_true(rest >= 0 && rest < 1);
        counts[(int)(rest * CELLS)]++;
    }
    for (int i = 0; i < CELLS; i++) expected[i] = (double)DRAWS / CELLS;
    assert_true(chi_square_p(counts, expected, CELLS) > 1e-3);
    float rest;
    distribution_pick(t.cdf, t.guide, t.count, 0x1.fffffep-1f, 0x1.fffffep-1f, &rest);
    assert_true(rest < 1);
    table_free(&t);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_are_exact),
        cmocka_unit_test(picks_match_probabilities),
        cmocka_unit_test(rests_are_uniform),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
