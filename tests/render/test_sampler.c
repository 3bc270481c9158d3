/* Stratification, independence and purity of the random numbers. Statistical tests are at the level of one false alarm in
 * a thousand for each test function (Šidák); seeds are fixed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "render/sample/sampler.h"
#include "tests/render/statistics.h"

#define LEVEL 1e-3

/* The points [first, first + 2^log2) are a (0, log2, 2)-net: each elementary interval of area 2^−log2, whatever its shape,
 * holds one of them. */
static void assert_net(const vec2 *points, int log2) {
    static uint8_t seen[1 << 12];
    for (int across = 0; across <= log2; across++) {
        int down = log2 - across;
        memset(seen, 0, sizeof seen);
        for (int i = 0; i < 1 << log2; i++) {
            int cell = (int)(points[i].x * (float)(1 << across)) << down | (int)(points[i].y * (float)(1 << down));
            if (seen[cell]++) fail_msg("2^%d points: two in an interval of 2^-%d x 2^-%d", log2, across, down);
        }
    }
}

static void plain_pairs_are_nets(void **state) {
    (void)state;
    static vec2 points[1 << 12];
    for (int log2 = 0; log2 <= 12; log2++)
        for (uint32_t block = 0; block < 3; block++) {
            for (uint32_t i = 0; i < 1u << log2; i++) {
                uint32_t n = (block << log2) + i;
                points[i] = (vec2){unit_float(reverse_bits(n)), unit_float(reverse_bits(sobol_second_reversed(n)))};
            }
            assert_net(points, log2);
        }
}

static void scrambled_pairs_are_nets(void **state) {
    (void)state;
    static vec2 points[1 << 12];
    for (uint32_t seed = 0; seed < 10; seed++)
        for (int log2 = 0; log2 <= 12; log2++)
            for (uint32_t block = 0; block < 2; block++) {
                uint32_t key = sample_key((sample_purpose)(seed % SAMPLE_PURPOSE_COUNT), seed);
                for (uint32_t i = 0; i < 1u << log2; i++)
                    points[i] = sample_sobol((sample_point){(block << log2) + i, hash32(seed)}, key);
                assert_net(points, log2);
            }
}

/* Direction numbers of the second dimension: v1 = 1/2, v(i+1) = v(i) xor v(i)/2, from the polynomial x + 1 (Bratley and
 * Fox 1988, Algorithm 659). */
static void second_dimension_follows_its_recurrence(void **state) {
    (void)state;
    uint32_t direction[32] = {0x80000000u};
    for (int i = 1; i < 32; i++) direction[i] = direction[i - 1] ^ direction[i - 1] >> 1;
    for (uint32_t i = 0; i < 100000; i++) {
        uint32_t index = i < 4096 ? i : hash32(i), expected = 0;
        for (int bit = 0; bit < 32; bit++) expected ^= index >> bit & 1 ? direction[bit] : 0;
        if (reverse_bits(sobol_second_reversed(index)) != expected) fail_msg("point %u", index);
    }
}

/* A bit of the hash depends on the bits below it alone, and each level of that tree is a permutation. */
static void owen_hash_is_nested(void **state) {
    (void)state;
    for (uint32_t seed = 0; seed < 50; seed++)
        for (int bits = 1; bits <= 32; bits++) {
            uint32_t x = hash_pair(seed, 1), below = bits < 32 ? (1u << bits) - 1 : ~0u, top = 1u << (bits - 1);
            uint32_t other = (x & below) | (hash_pair(seed, 2) & ~below), s = hash32(seed);
            assert_int_equal(owen_hash(x, s) & below, owen_hash(other, s) & below);
            assert_int_equal((owen_hash(x, s) ^ owen_hash(x ^ top, s)) & below, top);
        }
}

/* A quarter disk and a tent, minus their integrals: errors of a sampler show in both. */
static double integrand(vec2 u) {
    double x = (double)u.x, y = (double)u.y;
    return (x * x + y * y < 1) - M_PI / 4 + fabs(x - 0.3) * (y - 0.5) + x * y - 0.25;
}

static double correlation(double (*error)(uint32_t trial, int half), uint32_t trials) {
    double sums[5] = {0};
    for (uint32_t t = 0; t < trials; t++) {
        double a = error(t, 0), b = error(t, 1);
        sums[0] += a, sums[1] += b, sums[2] += a * a, sums[3] += b * b, sums[4] += a * b;
    }
    double n = trials, ma = sums[0] / n, mb = sums[1] / n;
    return (sums[4] / n - ma * mb) / sqrt((sums[2] / n - ma * ma) * (sums[3] / n - mb * mb));
}

enum { HALF = 32 };

static double replicate_error(uint32_t pixel, int replicate) {
    double sum = 0;
    for (uint32_t n = 0; n < HALF; n++) {
        sample_point p = sample_point_make(7, pixel, KILN_REPLICATES * n + (uint32_t)replicate);
        sum += integrand(sample_sobol(p, sample_key(SAMPLE_LIGHT, 1)));
    }
    return sum / HALF;
}

/* What taking halves of one sequence for replicates would have been. */
static double half_error(uint32_t pixel, int half) {
    sample_point p = sample_point_make(7, pixel, 0);
    double sum = 0;
    for (uint32_t n = 0; n < HALF; n++) {
        p.index = HALF * (uint32_t)half + n;
        sum += integrand(sample_sobol(p, sample_key(SAMPLE_LIGHT, 1)));
    }
    return sum / HALF;
}

/* Under independence the correlation of n pairs is normal with variance 1/n. */
static void replicates_err_independently(void **state) {
    (void)state;
    enum { TRIALS = 10000 };
    double replicates = correlation(replicate_error, TRIALS), halves = correlation(half_error, TRIALS);
    print_message("correlation of errors: replicates %.4f ± %.4f, halves of one sequence %.4f\n", replicates,
                  1 / sqrt(TRIALS), halves);
    assert_true(normal_tail(replicates * sqrt(TRIALS)) > LEVEL);
    assert_true(normal_tail(halves * sqrt(TRIALS)) < 1e-12);
}

/* Stratification pays: the variance of 32 samples of a smooth integrand falls as n⁻³, by chance as 1/n. */
static void stratification_beats_chance(void **state) {
    (void)state;
    tally sobol = {0}, independent = {0};
    for (uint32_t pixel = 0; pixel < 2000; pixel++) {
        double s = 0, i = 0;
        for (uint32_t n = 0; n < HALF; n++) {
            sample_point p = sample_point_make(7, pixel, KILN_REPLICATES * n);
            vec2 a = sample_pair(0, p, SAMPLE_LIGHT, 1), b = sample_pair(1, p, SAMPLE_LIGHT, 1);
            s += (double)(a.x * a.y) / HALF;
            i += (double)(b.x * b.y) / HALF;
        }
        tally_add(&sobol, s - 0.25);
        tally_add(&independent, i - 0.25);
    }
    assert_true(tally_variance(&sobol) < 0.02 * tally_variance(&independent));
    assert_true(normal_tail(sobol.mean / tally_error(&sobol)) > LEVEL); /* both without bias */
    assert_true(normal_tail(independent.mean / tally_error(&independent)) > LEVEL);
}

enum { SIDE = 16, CELLS = SIDE * SIDE, DRAWS = 1 << 16 };

/* p-value of pairs against the uniform distribution on the square. */
static double uniform_p(vec2 (*draw)(uint32_t n)) {
    static double counts[CELLS], expected[CELLS];
    memset(counts, 0, sizeof counts);
    for (uint32_t n = 0; n < DRAWS; n++) {
        vec2 u = draw(n);
        if (!(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1)) return 0;
        counts[(int)(u.x * SIDE) * SIDE + (int)(u.y * SIDE)]++;
    }
    for (int i = 0; i < CELLS; i++) expected[i] = (double)DRAWS / CELLS;
    return chi_square_p(counts, expected, CELLS);
}

/* The samples of a few pixels; of many pixels; one number of two purposes, depths, neighbours in the sequence. */
static vec2 of_samples(uint32_t n) { return sample_independent(sample_point_make(1, n >> 12, n & 4095), 3); }
static vec2 of_pixels(uint32_t n) { return sample_independent(sample_point_make(1, n, 5), 3); }
static vec2 of_seeds(uint32_t n) { return sample_independent(sample_point_make(n, 12, 0), 3); }
static vec2 of_keys(uint32_t n) { return sample_independent(sample_point_make(1, 0, 0), n); }
static vec2 of_neighbours(uint32_t n) {
    return (vec2){sample_independent(sample_point_make(1, 9, n), 3).x, sample_independent(sample_point_make(1, 9, n + 1), 3).x};
}
static vec2 of_replicates(uint32_t n) {
    return (vec2){sample_independent(sample_point_make(1, 9, 2 * n), 3).x, sample_independent(sample_point_make(1, 9, 2 * n + 1), 3).x};
}
static vec2 of_purposes(uint32_t n) {
    return (vec2){sample_independent(sample_point_make(1, 9, n), sample_key(SAMPLE_LIGHT, 0)).x,
                  sample_independent(sample_point_make(1, 9, n), sample_key(SAMPLE_BSDF, 0)).x};
}
/* Padding: one point of each pixel's sequences, of two purposes, or of one purpose. */
static vec2 of_sobol_purposes(uint32_t n) {
    return (vec2){sample_sobol(sample_point_make(1, n, 6), sample_key(SAMPLE_LIGHT, 0)).x,
                  sample_sobol(sample_point_make(1, n, 6), sample_key(SAMPLE_BSDF, 0)).y};
}
static vec2 of_sobol_depths(uint32_t n) {
    return (vec2){sample_sobol(sample_point_make(1, n, 0), sample_key(SAMPLE_BSDF, 0)).x,
                  sample_sobol(sample_point_make(1, n, 0), sample_key(SAMPLE_BSDF, 1)).x};
}
static vec2 of_sobol_pixels(uint32_t n) { return sample_sobol(sample_point_make(1, n, 3), sample_key(SAMPLE_BSDF, 2)); }
static vec2 of_sobol_seeds(uint32_t n) { return sample_sobol(sample_point_make(n, 3, 3), sample_key(SAMPLE_BSDF, 2)); }

static void numbers_are_uniform(void **state) {
    (void)state;
    static const struct { const char *name; vec2 (*draw)(uint32_t); } rows[] = {
        {"samples", of_samples}, {"pixels", of_pixels}, {"seeds", of_seeds}, {"keys", of_keys},
        {"neighbours", of_neighbours}, {"replicates", of_replicates}, {"purposes", of_purposes},
        {"Sobol purposes", of_sobol_purposes}, {"Sobol depths", of_sobol_depths}, {"Sobol pixels", of_sobol_pixels},
        {"Sobol seeds", of_sobol_seeds},
    };
    const size_t count = sizeof rows / sizeof *rows;
    for (size_t i = 0; i < count; i++) {
        double p = uniform_p(rows[i].draw);
        if (p < sidak(LEVEL, (double)count)) fail_msg("%s: p = %g", rows[i].name, p);
    }
}

static int by_key(const void *a, const void *b) {
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static void keys_are_distinct(void **state) {
    (void)state;
    enum { DEPTHS = 512 };
    static uint32_t keys[DEPTHS * SAMPLE_PURPOSE_COUNT];
    uint32_t count = 0;
    for (uint32_t depth = 0; depth < DEPTHS; depth++)
        for (int purpose = 0; purpose < SAMPLE_PURPOSE_COUNT; purpose++)
            keys[count++] = sample_key((sample_purpose)purpose, depth);
    qsort(keys, count, sizeof *keys, by_key);
    for (uint32_t i = 1; i < count; i++) assert_true(keys[i] != keys[i - 1]);
}

/* Sample n of pixel p, whatever was asked before; samples fall to the replicates in turn. */
static void samples_are_pure(void **state) {
    (void)state;
    enum { COUNT = 4096 };
    static vec2 kept[COUNT];
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < COUNT; i++) {
            uint32_t n = pass ? COUNT - 1 - i : i;
            sample_point p = sample_point_make(3, n >> 6, n & 63);
            vec2 u = sample_pair(0, p, SAMPLE_BSDF, n & 7);
            if (!pass) kept[n] = u;
            assert_true(u.x == kept[n].x && u.y == kept[n].y);
            assert_int_equal(p.index, (n & 63) / KILN_REPLICATES);
        }
    assert_int_not_equal(sample_point_make(3, 5, 0).seed, sample_point_make(3, 5, 1).seed);
    assert_int_equal(sample_point_make(3, 5, 0).seed, sample_point_make(3, 5, KILN_REPLICATES).seed);
    assert_int_not_equal(sample_point_make(3, 5, 0).seed, sample_point_make(4, 5, 0).seed);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_pairs_are_nets),
        cmocka_unit_test(scrambled_pairs_are_nets),
        cmocka_unit_test(second_dimension_follows_its_recurrence),
        cmocka_unit_test(owen_hash_is_nested),
        cmocka_unit_test(replicates_err_independently),
        cmocka_unit_test(stratification_beats_chance),
        cmocka_unit_test(numbers_are_uniform),
        cmocka_unit_test(keys_are_distinct),
        cmocka_unit_test(samples_are_pure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
