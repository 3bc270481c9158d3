/* base/fmath.h against double precision: the stated errors over each domain, the stated values outside it, and loops
 * against single calls. */
#include "base/fmath.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/hash.h"
#include "fmath_loops.h"

#define QUIET_NAN fm_from_bits(0x7fc00000u)
#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

/* The distance from got to the exact value, in units of the last place of the float nearest to it. */
static double ulps(float got, double exact) {
    if (exact != exact) return got != got ? 0 : INFINITY;
    if (got != got) return INFINITY;
    if (isinf((float)exact) && isinf(got)) return (exact > 0) == (got > 0) ? 0 : INFINITY;
    if (isinf(exact)) return INFINITY;
    int exponent;
    (void)frexp(exact, &exponent);
    double unit = ldexp(1.0, exponent - 24 < -149 ? -149 : exponent - 24);
    return fabs((isinf(got) ? copysign(0x1p128, (double)got) : (double)got) - exact) / unit;
}

static float single_sin_2pi(float u) { return fm_sincos_2pi(u).sin; }
static float single_cos_2pi(float u) { return fm_sincos_2pi(u).cos; }
/* Reduced exactly to an eighth of a turn first: sin(2 π u) of a large double u would be off. */
static double exact_turn(double u, int quarters) {
    double quarter = rint(4 * u), angle = 2 * M_PI * (u - quarter / 4);
    int quadrant = ((int)quarter + quarters) & 3;
    double value = quadrant & 1 ? cos(angle) : sin(angle);
    return quadrant & 2 ? -value : value;
}
static double exact_sin_2pi(double u) { return exact_turn(u, 0); }
static double exact_cos_2pi(double u) { return exact_turn(u, 1); }
static double exact_acos(double x) { return acos(x > 1 ? 1 : x < -1 ? -1 : x); }

typedef struct row {
    const char *name;
    float (*function)(float);
    double (*exact)(double);
    float low, high; /* the domain in which the error is stated */
    double error;
} row;

static float single_sin(float x) { return fm_sin(x); }
static float single_cos(float x) { return fm_cos(x); }
static float single_exp(float x) { return fm_exp(x); }
static float single_exp2(float x) { return fm_exp2(x); }
static float single_log(float x) { return fm_log(x); }
static float single_log2(float x) { return fm_log2(x); }
static float single_acos(float x) { return fm_acos(x); }
static float single_floor(float x) { return fm_floor(x); }

static const row rows[] = {
    {"sin", single_sin, sin, -256, 256, 2.5},
    {"cos", single_cos, cos, -256, 256, 2.5},
    {"sin_2pi", single_sin_2pi, exact_sin_2pi, -0x1p20f, 0x1p20f, 1.7},
    {"cos_2pi", single_cos_2pi, exact_cos_2pi, -0x1p20f, 0x1p20f, 1.7},
    {"exp", single_exp, exp, -INFINITY, INFINITY, 1.0},
    {"exp2", single_exp2, exp2, -INFINITY, INFINITY, 1.2},
    {"log", single_log, log, 0, INFINITY, 0.9},
    {"log2", single_log2, log2, 0, INFINITY, 1.5},
    {"acos", single_acos, exact_acos, -INFINITY, INFINITY, 1.2},
    {"floor", single_floor, floor, -INFINITY, INFINITY, 0},
};

static void check_row(const row *r, float x, double *worst, float *where) {
    if (!(x >= r->low && x <= r->high)) return;
    double error = ulps(r->function(x), r->exact((double)x));
    if (error <= *worst) return;
    *worst = error;
    *where = x;
}

/* Every 2003rd float of all 2³², and every float of a stretch around 1, where most of these functions are hardest. */
static void errors_are_as_stated(void **state) {
    (void)state;
    for (int i = 0; i < COUNT(rows); i++) {
        double worst = 0;
        float where = 0;
        for (uint64_t bits = 0; bits <= UINT32_MAX; bits += 2003)
            check_row(&rows[i], fm_from_bits((uint32_t)bits), &worst, &where);
        for (uint32_t bits = 0x3f7f8000u; bits < 0x3f808000u; bits++)
            check_row(&rows[i], fm_from_bits(bits), &worst, &where);
        if (worst > rows[i].error)
            fail_msg("%s(%a) is off by %.3f ulp; %.1f are stated", rows[i].name, (double)where, worst, rows[i].error);
    }
}

static uint32_t random_bits(uint32_t n, uint32_t stream) { return hash_pair(n, stream); }
/* Positive, with exponents within ±range of 1. */
static float random_float(uint32_t n, uint32_t stream, uint32_t range) {
    uint32_t bits = random_bits(n, stream);
    return fm_from_bits((127 - range + (bits >> 23) % (2 * range + 1)) << 23 | (bits & 0x7fffffu));
}

static void check_pow(float x, float y) {
    double error = ulps(fm_pow(x, y), pow((double)x, (double)y));
    if (error > 0.8) fail_msg("pow(%a, %a) is off by %.3f ulp", (double)x, (double)y, error);
}

static void pow_is_within_its_error(void **state) {
    (void)state;
    for (uint32_t i = 0; i < 500000; i++) {
        float any = fm_from_bits(random_bits(i, 1) & 0x7fffffffu), y = random_float(i, 2, 12);
        if (any == any) check_pow(any, fm_from_bits(fm_bits(y) | (i << 31)));
        check_pow(random_float(i, 3, 4), fm_from_bits(fm_bits(random_float(i, 4, 6)) | (i << 31)));
        check_pow(unit_float(random_bits(i, 5)), y);
        check_pow(1.0f + (unit_float(random_bits(i, 6)) - 0.5f) * 0x1p-10f, y * 0x1p8f); /* near 1, large exponents */
    }
}

static void check_atan2(float y, float x) {
    double error = ulps(fm_atan2(y, x), atan2((double)y, (double)x));
    if (error > 1.6) fail_msg("atan2(%a, %a) is off by %.3f ulp", (double)y, (double)x, error);
}

static void atan2_is_within_its_error(void **state) {
    (void)state;
    for (uint32_t i = 0; i < 1000000; i++) {
        float y = fm_from_bits(random_bits(i, 1)), x = fm_from_bits(random_bits(i, 2));
        if (y == y && x == x) check_atan2(y, x);
        uint32_t signs = random_bits(i, 5);
        check_atan2(fm_from_bits(fm_bits(random_float(i, 3, 3)) | signs << 31),
                    fm_from_bits(fm_bits(random_float(i, 4, 3)) | (signs >> 1) << 31));
    }
}

static void same(const char *what, float x, float y, float got, float want) {
    bool both_nan = got != got && want != want;
    if (!both_nan && fm_bits(got) != fm_bits(want))
        fail_msg("%s(%a, %a) is %a, not %a", what, (double)x, (double)y, (double)got, (double)want);
}

static void edges_are_as_stated(void **state) {
    (void)state;
    const float nan = QUIET_NAN, inf = INFINITY;
    const struct {
        const char *name;
        float (*function)(float);
        float x, want;
    } edges[] = {
        {"sin", single_sin, -0.0f, 0.0f},
        {"sin", single_sin, inf, nan},
        {"sin", single_sin, -inf, nan},
        {"sin", single_sin, nan, nan},
        {"sin", single_sin, 256.01f, nan},
        {"sin", single_sin, 1e30f, nan},
        {"cos", single_cos, 0.0f, 1.0f},
        {"cos", single_cos, inf, nan},
        {"cos", single_cos, nan, nan},
        {"cos", single_cos, -257.0f, nan},
        {"sin_2pi", single_sin_2pi, 0.25f, 1.0f},
        {"sin_2pi", single_sin_2pi, 0.5f, -0.0f},
        {"sin_2pi", single_sin_2pi, 0.75f, -1.0f},
        {"sin_2pi", single_sin_2pi, 1.0f, 0.0f},
        {"sin_2pi", single_sin_2pi, inf, nan},
        {"sin_2pi", single_sin_2pi, 0x1.1p20f, nan},
        {"cos_2pi", single_cos_2pi, 0.0f, 1.0f},
        {"cos_2pi", single_cos_2pi, 0.5f, -1.0f},
        {"cos_2pi", single_cos_2pi, 0.25f, -0.0f},
        {"cos_2pi", single_cos_2pi, nan, nan},
        {"exp", single_exp, 0.0f, 1.0f},
        {"exp", single_exp, inf, inf},
        {"exp", single_exp, -inf, 0.0f},
        {"exp", single_exp, 88.8f, inf},
        {"exp", single_exp, 1e30f, inf},
        {"exp", single_exp, -104.0f, 0.0f},
        {"exp", single_exp, -1e30f, 0.0f},
        {"exp", single_exp, nan, nan},
        {"exp", single_exp, -nan, nan},
        {"exp2", single_exp2, 127.0f, 0x1p127f},
        {"exp2", single_exp2, 128.0f, inf},
        {"exp2", single_exp2, inf, inf},
        {"exp2", single_exp2, -126.0f, 0x1p-126f},
        {"exp2", single_exp2, -149.0f, 0x1p-149f},
        {"exp2", single_exp2, -151.0f, 0.0f},
        {"exp2", single_exp2, -inf, 0.0f},
        {"exp2", single_exp2, nan, nan},
        {"log", single_log, 1.0f, 0.0f},
        {"log", single_log, 0.0f, -inf},
        {"log", single_log, -0.0f, -inf},
        {"log", single_log, -1.0f, nan},
        {"log", single_log, -inf, nan},
        {"log", single_log, inf, inf},
        {"log", single_log, nan, nan},
        {"log2", single_log2, 1.0f, 0.0f},
        {"log2", single_log2, 0x1p100f, 100.0f},
        {"log2", single_log2, 0x1p-149f, -149.0f},
        {"log2", single_log2, 0.0f, -inf},
        {"log2", single_log2, -0x1p-149f, nan},
        {"log2", single_log2, inf, inf},
        {"log2", single_log2, nan, nan},
        {"acos", single_acos, 1.0f, 0.0f},
        {"acos", single_acos, -1.0f, FM_PI},
        {"acos", single_acos, 0.0f, FM_PI / 2},
        {"acos", single_acos, 1.0000001f, 0.0f},
        {"acos", single_acos, -inf, FM_PI},
        {"acos", single_acos, inf, 0.0f},
        {"acos", single_acos, nan, nan},
        {"floor", single_floor, -0.0f, -0.0f},
        {"floor", single_floor, -0.25f, -1.0f},
        {"floor", single_floor, inf, inf},
        {"floor", single_floor, nan, nan},
        {"floor", single_floor, 0x1.8p22f, 0x1.8p22f},
    };
    for (int i = 0; i < COUNT(edges); i++)
        same(edges[i].name, edges[i].x, 0, edges[i].function(edges[i].x), edges[i].want);
}

static void pow_edges_are_as_stated(void **state) {
    (void)state;
    const float nan = QUIET_NAN, inf = INFINITY;
    const float pairs[][3] = {
        {0, 0, 1}, {-0.0f, 0, 1}, {inf, 0, 1}, {7, -0.0f, 1}, {1, inf, 1}, {1, -inf, 1}, {1, 1e38f, 1},
        {0, 1e-45f, 0}, {0, 3, 0}, {0, inf, 0}, {0, -1e-45f, inf}, {0, -2, inf}, {-0.0f, -1, inf},
        {inf, 1e-45f, inf}, {inf, 2, inf}, {inf, -2, 0}, {inf, -inf, 0}, {2, inf, inf}, {2, -inf, 0}, {0.5f, inf, 0},
        {0.5f, -inf, inf}, {2, 128, inf}, {2, -149, 0x1p-149f}, {2, -151, 0}, {10, 39, inf}, {10, -46, 0},
        {-1, 2, nan}, {-1e-45f, 0.5f, nan}, {-inf, 1, nan}, {nan, 0, nan}, {nan, 1, nan}, {1, nan, nan}, {0, nan, nan},
        {0x1.000002p0f, 3e9f, inf}, {3, 2, 9}, {0.25f, 0.5f, 0.5f},
    };
    for (int i = 0; i < COUNT(pairs); i++)
        same("pow", pairs[i][0], pairs[i][1], fm_pow(pairs[i][0], pairs[i][1]), pairs[i][2]);
}

/* As C says it (C11 F.10.1.4), by the C library itself; the signs of zeros too. */
static void atan2_edges_are_cs(void **state) {
    (void)state;
    const float values[] = {0.0f, -0.0f, 1.0f, -1.0f, INFINITY, -INFINITY, 1e-45f, -1e-45f, 3e38f, -3e38f, QUIET_NAN};
    for (int i = 0; i < COUNT(values); i++)
        for (int j = 0; j < COUNT(values); j++) {
            check_atan2(values[i], values[j]);
            float got = fm_atan2(values[i], values[j]);
            if (got == got) assert_int_equal(signbit(got) != 0, signbit(values[i]) != 0);
        }
}

static void selections_treat_nan_as_stated(void **state) {
    (void)state;
    const float nan = QUIET_NAN;
    assert_true(fm_min(1.0f, 2.0f) == 1.0f && fm_max(1.0f, 2.0f) == 2.0f);
    assert_true(fm_min(nan, 1.0f) == 1.0f && fm_max(nan, 1.0f) == 1.0f);
    same("min", 1, nan, fm_min(1.0f, nan), nan);
    same("max", 1, nan, fm_max(1.0f, nan), nan);
    same("clamp", nan, 0, fm_clamp(nan, 0.0f, 1.0f), nan);
    assert_true(fm_clamp(-INFINITY, 0.0f, 1.0f) == 0.0f && fm_clamp(INFINITY, 0.0f, 1.0f) == 1.0f);
    assert_true(fm_clamp(0.5f, 0.0f, 1.0f) == 0.5f);
    assert_true(fm_lerp(0.1f, 0.7f, 0.0f) == 0.1f && fm_lerp(0.1f, 0.7f, 1.0f) == 0.7f);
    assert_true(fm_select(1, 2.0f, 3.0f) == 2.0f && fm_select(0, 2.0f, 3.0f) == 3.0f);
}

#define LOOP_COUNT 1021 /* not a multiple of any vector's length */

/* Vectorised or not, the bits are the same: the compiler may not contract, reassociate or approximate. */
static void next_up_is_cs(void **state) {
    (void)state;
    const float places[] = {0.0f, -0.0f, 0x1p-149f, 0x1.fffffcp-127f, 0x1p-126f, 0x1.fffffep-1f, 1, 0x1.fffffep127f,
                            INFINITY};
    for (int i = 0; i < COUNT(places); i++) assert_true(fm_next_up(places[i]) == nextafterf(places[i], INFINITY));
    assert_true(isnan(fm_next_up(QUIET_NAN)));
}

static void loops_equal_single_calls(void **state) {
    (void)state;
    static float x[LOOP_COUNT], y[LOOP_COUNT], result[LOOP_COUNT];
    for (uint32_t i = 0; i < LOOP_COUNT; i++) {
        x[i] = i % 3 ? random_float(i, 1, 7) : fm_from_bits(random_bits(i, 2));
        y[i] = i % 5 ? random_float(i, 3, 7) : fm_from_bits(random_bits(i, 4));
    }
#define FMATH_LOOP(name, expression)                                                                                   \
    loop_##name(result, x, y, LOOP_COUNT);                                                                             \
    for (int i = 0; i < LOOP_COUNT; i++) {                                                                             \
        volatile float a_ = x[i], b_ = y[i]; /* keeps this loop scalar */                                              \
        float a = a_, b = b_;                                                                                          \
        (void)b;                                                                                                       \
        same("loop " #name, a, b, result[i], expression);                                                              \
    }
    FMATH_LOOPS(FMATH_LOOP)
#undef FMATH_LOOP
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_as_stated),       cmocka_unit_test(pow_is_within_its_error),
        cmocka_unit_test(atan2_is_within_its_error),  cmocka_unit_test(edges_are_as_stated),
        cmocka_unit_test(pow_edges_are_as_stated),    cmocka_unit_test(atan2_edges_are_cs),
        cmocka_unit_test(selections_treat_nan_as_stated), cmocka_unit_test(next_up_is_cs),
        cmocka_unit_test(loops_equal_single_calls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
