/* The filter's inverse cumulative distribution against its formula. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "render/sample/filter.h"

/* The formulas again, on [−1, 1]: Harris 1978, table I; a Gaussian cut at three standard deviations. */
static double density(kiln_pixel_filter kind, double x) {
    double t = M_PI * (x + 1);
    if (kind == KILN_PIXEL_BOX) return 1;
    if (kind == KILN_PIXEL_GAUSSIAN) return exp(-4.5 * x * x);
    return 0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2 * t) - 0.01168 * cos(3 * t);
}

/* Cumulative distribution in closed form. */
static double cumulative(kiln_pixel_filter kind, double x) {
    double t = M_PI * (x + 1);
    if (kind == KILN_PIXEL_BOX) return 0.5 * (x + 1);
    if (kind == KILN_PIXEL_GAUSSIAN) return 0.5 + 0.5 * erf(3 * x / M_SQRT2) / erf(3 / M_SQRT2);
    return (0.35875 * t - 0.48829 * sin(t) + 0.14128 * sin(2 * t) / 2 - 0.01168 * sin(3 * t) / 3) / (0.35875 * 2 * M_PI);
}

static const kiln_pixel_filter kinds[] = {KILN_PIXEL_BOX, KILN_PIXEL_GAUSSIAN, KILN_PIXEL_BLACKMAN_HARRIS};
static const double widths[] = {0.25, 1, 2, 3.5, 8};

/* What is drawn with u lies where a share u of the formula's mass is to its left. Between nodes, 1/512 of the mass apart,
 * the density counts as constant. */
static void offsets_follow_the_formula(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++)
        for (int w = 0; w < 5; w++) {
            pixel_filter f;
            pixel_filter_make(&f, kinds[k], widths[w]);
            double radius = 0.5 * widths[w], before = -radius;
            for (uint32_t i = 0; i < 1u << 16; i++) {
                float u = (float)i * 0x1p-16f;
                double x = (double)pixel_filter_offset(&f, u), off = cumulative(kinds[k], x / radius) - (double)u;
                if (fabs(off) > 1e-3 || x < before || fabs(x) > radius)
                    fail_msg("filter %d of width %g: %g for u = %g, %g of the mass off", kinds[k], widths[w], x, (double)u, off);
                before = x;
            }
            assert_true(pixel_filter_offset(&f, 0x1.fffffep-1f) <= (float)radius);
        }
}

/* Mean, variance and fourth moment, by midpoints in u and in x. The last 1/512 of the mass to either side lies straight
 * between two nodes, which lengthens tails: by 5 % of Blackman and Harris' fourth moment. */
static void moments_agree(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        enum { STEPS = 1 << 14 };
        pixel_filter f;
        pixel_filter_make(&f, kinds[k], 2);
        double mass = 0, second = 0, fourth = 0, mean = 0, drawn2 = 0, drawn4 = 0;
        for (int i = 0; i < STEPS; i++) {
            double x = 2 * (i + 0.5) / STEPS - 1, d = density(kinds[k], x);
            double y = (double)pixel_filter_offset(&f, ((float)i + 0.5f) / STEPS);
            mass += d, second += d * x * x, fourth += d * x * x * x * x;
            mean += y / STEPS, drawn2 += y * y / STEPS, drawn4 += y * y * y * y / STEPS;
        }
        assert_true(fabs(mean) < 1e-5);
        assert_true(fabs(drawn2 - second / mass) < 0.01 * second / mass);
        assert_true(fabs(drawn4 - fourth / mass) < 0.05 * fourth / mass);
    }
}

static void widths_scale(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        pixel_filter one, three, standard, odd;
        pixel_filter_make(&one, kinds[k], 1);
        pixel_filter_make(&three, kinds[k], 3);
        for (int i = 0; i <= FILTER_NODES; i++) {
            assert_true(fabsf(three.offset[i] - 3 * one.offset[i]) <= 1e-6f);
            assert_true(fabsf(one.offset[i] + one.offset[FILTER_NODES - i]) < 1e-5f); /* symmetric */
        }
        assert_true(one.offset[0] == -0.5f && one.offset[FILTER_NODES] == 0.5f);
        /* 0, and what is no width, mean the default. */
        pixel_filter_make(&standard, kinds[k], 0);
        pixel_filter_make(&odd, kinds[k], NAN);
        assert_true(standard.offset[FILTER_NODES] == (kinds[k] == KILN_PIXEL_BOX ? 0.5f : 1.5f));
        assert_memory_equal(&standard, &odd, sizeof odd);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(offsets_follow_the_formula),
        cmocka_unit_test(moments_agree),
        cmocka_unit_test(widths_scale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
