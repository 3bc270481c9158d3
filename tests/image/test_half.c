#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "image/half.h"
#include "base/hash.h"

/* By the definition: (1 + m/1024) 2^(e − 15), m/1024 2^−14 for e = 0, infinity and NaN for e = 31. */
static double by_definition(uint16_t half) {
    int exponent = half >> 10 & 31, mantissa = half & 1023;
    double value = exponent == 31 ? (mantissa ? (double)NAN : (double)INFINITY)
                   : exponent     ? ldexp(1024 + mantissa, exponent - 25)
                                  : ldexp(mantissa, -24);
    return half >> 15 ? -value : value;
}

static void every_half_becomes_its_float_and_comes_back(void **state) {
    (void)state;
    for (uint32_t bits = 0; bits <= 0xffff; bits++) {
        uint16_t half = (uint16_t)bits;
        double want = by_definition(half);
        float got = half_to_float(half);
        if (want != want) {
            assert_true(got != got);
            assert_true(half_to_float(float_to_half(got)) != half_to_float(float_to_half(got)));
            continue;
        }
        assert_true((double)got == want && (signbit(got) != 0) == (half >> 15 != 0));
        if (!isinf(got)) assert_int_equal(float_to_half(got), half);
    }
}

/* The neighbour is never nearer, and in a tie the mantissa is even. */
static void floats_go_to_the_nearest_half(void **state) {
    (void)state;
    for (uint32_t i = 0; i < 2000000; i++) {
        uint32_t bits = hash32(i);
        if (i % 2) bits = (bits & 0x807fffffu) | (uint32_t)(100 + i / 2 % 44) << 23;
        if (i % 7 == 0) bits &= 0xffffe000u; /* exact ones */
        if (i % 7 == 1) bits = (bits & 0xffffe000u) | 0x1000u; /* ties */
        float value;
        memcpy(&value, &bits, sizeof value);
        if (value != value) continue;
        uint16_t half = float_to_half(value);
        if (fabsf(value) >= 65504.0f) {
            assert_int_equal(half & 0x7fff, 0x7bff);
            continue;
        }
        double magnitude = fabs((double)value), error = fabs(by_definition(half & 0x7fff) - magnitude);
        double above = fabs(by_definition((uint16_t)((half & 0x7fff) + 1)) - magnitude);
        double below = half & 0x7fff ? fabs(by_definition((uint16_t)((half & 0x7fff) - 1)) - magnitude) : INFINITY;
        if (error > above || error > below || ((error == above || error == below) && half & 1))
            fail_msg("%a becomes %a", (double)value, by_definition(half));
        assert_int_equal(half >> 15, signbit(value) != 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_becomes_its_float_and_comes_back),
        cmocka_unit_test(floats_go_to_the_nearest_half),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
