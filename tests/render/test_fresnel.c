/* Fresnel terms against closed forms in double precision. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "render/bsdf/fresnel.h"

/* Born and Wolf, Principles of Optics, 1.5.2: the mean of both polarisations. */
static double exact(double c, double eta) {
    double sine2 = (1 - c * c) / (eta * eta);
    if (sine2 >= 1) return 1;
    double t = sqrt(1 - sine2), s = (c - eta * t) / (c + eta * t), p = (t - eta * c) / (t + eta * c);
    return 0.5 * (s * s + p * p);
}

/* The first and the last are what an infinite index counts as; g² is then lost in rounding. */
static const float etas[] = {1.0f / 1000, 1 / 2.4f, 1 / 1.5f, 1 / 1.05f, 1, 1.0001f, 1.05f, 1.33f, 1.5f, 2.4f, 10, 1000};
enum { ETAS = sizeof etas / sizeof *etas };

static void agrees_with_the_equations(void **state) {
    (void)state;
    for (int e = 0; e < ETAS; e++)
        for (int i = 0; i <= 1000; i++) {
            float c = (float)i / 1000, f = fresnel_dielectric(c, etas[e]);
            double n = (double)etas[e], g2 = n * n - 1 + (double)(c * c), wanted = exact((double)c, n);
            /* Near total reflection and at grazing incidence F changes as the root of what rounding leaves. */
            double error = 2e-6 + 1e-7 * fmax(1, n * n) / fmax(fabs(g2), 1e-9);
            if (!(f >= 0 && f <= 1.000001f) || fabs((double)f - wanted) > error)
                fail_msg("eta %g, cos %g: %.8f instead of %.8f", n, (double)c, (double)f, wanted);
        }
}

static void has_its_known_values(void **state) {
    (void)state;
    for (int e = 1; e < ETAS; e++) {
        double n = (double)etas[e], root = (n - 1) / (n + 1), brewster = atan(n);
        assert_true(fabs((double)fresnel_dielectric(1, etas[e]) - root * root) < 1e-6);
        /* At Brewster's angle one polarisation is not reflected, the other by cos²(2 θ). */
        double half = 0.5 * pow(cos(2 * brewster), 2);
        if (n < 100) assert_true(fabs((double)fresnel_dielectric((float)cos(brewster), etas[e]) - half) < 1e-6);
        if (n >= 1) continue;
        double critical = sqrt(1 - n * n);
        assert_true(fresnel_dielectric((float)critical * 0.999f, etas[e]) == 1);
        assert_true(fresnel_dielectric(fminf((float)critical * 1.01f, 1), etas[e]) < 1);
        assert_true(fresnel_dielectric(0, etas[e]) == 1);
    }
    for (int i = 1; i <= 100; i++) assert_true(fresnel_dielectric((float)i / 100, 1) < 1e-12f);
    assert_true(fresnel_dielectric(1e-7f, 1.5f) > 0.99999f);
}

/* Both sides reflect alike, each at its own angle (Snell). The denser side finds the other's cosine with an error. */
static void is_the_same_from_both_sides(void **state) {
    (void)state;
    for (int e = 1; e + 1 < ETAS; e++)
        for (int i = 1; i <= 100; i++) {
            double c = i / 100.0, n = (double)etas[e], k = 1 - (1 - c * c) / (n * n), least = fmin(c, sqrt(fmax(k, 0)));
            if (k < 0.01) continue;
            float there = fresnel_dielectric((float)c, etas[e]), back = fresnel_dielectric((float)sqrt(k), 1 / etas[e]);
            if (fabs((double)there - (double)back) > 2e-5 + 5e-7 / (least * least)) fail_msg("eta %g, cos %g: %g and %g", n, c, (double)there, (double)back);
        }
}

static void schlick_is_a_fifth_power(void **state) {
    (void)state;
    for (int i = 0; i <= 100; i++) {
        float c = (float)i / 100;
        assert_true(fabs((double)fresnel_schlick_weight(c) - pow(1 - (double)c, 5)) < 1e-6);
    }
    assert_true(fresnel_schlick_weight(1) == 0 && fresnel_schlick_weight(1.0000002f) == 0);
    assert_true(fresnel_schlick_weight(0) == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_equations),
        cmocka_unit_test(has_its_known_values),
        cmocka_unit_test(is_the_same_from_both_sides),
        cmocka_unit_test(schlick_is_a_fifth_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
