#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "base/hash.h"

/* Undone step by step: 0x1d69e2a5 and 0x43021123 are the inverses of the two odd factors modulo 2^32, and
 * x ^= x >> 15 is undone by x ^= x >> 15 ^ x >> 30. */
static uint32_t inverse(uint32_t x) {
    x ^= x >> 16;
    x *= 0x43021123u;
    x ^= x >> 15 ^ x >> 30;
    x *= 0x1d69e2a5u;
    x ^= x >> 16;
    return x;
}

static void hash32_is_a_bijection(void **state) {
    (void)state;
    assert_int_equal((uint32_t)(0x1d69e2a5u * 0x7feb352du), 1);
    assert_int_equal((uint32_t)(0x43021123u * 0x846ca68bu), 1);
    for (uint32_t i = 0; i < 1000000; i++) {
        uint32_t x = i * 4294967u;
        if (inverse(hash32(x)) != x) fail_msg("%u does not come back", x);
    }
}

/* Each bit of input turns each bit of output over with probability 1/2: within 5 standard deviations of a binomial
 * over 20,000 tries, 1,024 cells. */
static void one_bit_changes_half_of_all(void **state) {
    (void)state;
    enum { TRIES = 20000 };
    static int flips[32][32];
    for (uint32_t n = 0; n < TRIES; n++)
        for (int in = 0; in < 32; in++) {
            uint32_t difference = hash32(n) ^ hash32(n ^ 1u << in);
            for (int out = 0; out < 32; out++) flips[in][out] += (int)(difference >> out & 1);
        }
    for (int in = 0; in < 32; in++)
        for (int out = 0; out < 32; out++) {
            double deviation = fabs(flips[in][out] - TRIES / 2.0) / sqrt(TRIES / 4.0);
            if (deviation > 5) fail_msg("bit %d on bit %d: %d of %d", in, out, flips[in][out], TRIES);
        }
}

static int compare(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* 2^20 pairs of small numbers: a random function to 32 bits would collide about 2^40/2^33 = 128 times. */
static void pairs_collide_no_more_than_chance(void **state) {
    (void)state;
    enum { SIDE = 1024 };
    uint64_t *values = malloc(SIDE * SIDE * sizeof *values);
    int collisions = 0;
    for (uint32_t a = 0; a < SIDE; a++)
        for (uint32_t b = 0; b < SIDE; b++) values[a * SIDE + b] = hash_pair(a, b);
    qsort(values, SIDE * SIDE, sizeof *values, compare);
    for (size_t i = 1; i < SIDE * SIDE; i++) collisions += values[i] == values[i - 1];
    if (collisions > 128 + 6 * 12) fail_msg("%d collisions", collisions);
    free(values);
    assert_int_not_equal(hash_pair(1, 2), hash_pair(2, 1));
    assert_int_not_equal(hash_triple(1, 2, 3), hash_triple(3, 2, 1));
    assert_int_not_equal(hash_u64(1), hash_u64((uint64_t)1 << 32));
}

static void unit_floats_stay_below_one(void **state) {
    (void)state;
    assert_true(unit_float(0) == 0.0f && unit_float(255) == 0.0f && unit_float(256) == 0x1p-24f);
    assert_true(unit_float(UINT32_MAX) == 1.0f - 0x1p-24f);
    assert_true(unit_float(0x80000000u) == 0.5f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hash32_is_a_bijection),
        cmocka_unit_test(one_bit_changes_half_of_all),
        cmocka_unit_test(pairs_collide_no_more_than_chance),
        cmocka_unit_test(unit_floats_stay_below_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
