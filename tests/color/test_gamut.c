#include "tests/color/support.h"

#include "color/gamut.h"

static void assert_matrix(const double *m, const double *expected, double tolerance) {
    for (int k = 0; k < 9; k++)
        if (!(fabs(m[k] - expected[k]) <= tolerance)) fail_msg("element %d: %.9g is not %.9g", k, m[k], expected[k]);
}

/* IEC 61966-2-1, and SMPTE ST 2065-1 for AP0. */
static void published_matrices(void **state) {
    (void)state;
    const double srgb[] = {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505};
    const double ap0[] = {0.9525523959, 0, 0.0000936786, 0.3439664498, 0.7281660966, -0.0721325464, 0, 0, 1.0088251844};
    double m[9];
    gamut_to_xyz(gamut_find("lin_rec709"), m);
    assert_matrix(m, srgb, 5e-5);
    gamut_to_xyz(gamut_find("ACES2065-1"), m);
    assert_matrix(m, ap0, 1e-10);
    assert_null(gamut_find("lin_nothing"));
}

static void inverse_and_product(void **state) {
    (void)state;
    const double identity[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, m[] = {2, -1, 0, 3, 5, 1, 0.5, 0, 4};
    const double singular[] = {1, 2, 3, 2, 4, 6, 0, 1, 1};
    double inverse[9], product[9];
    assert_true(matrix3_invert(m, inverse));
    matrix3_multiply(m, inverse, product);
    assert_matrix(product, identity, 1e-15);
    matrix3_multiply(inverse, m, product);
    assert_matrix(product, identity, 1e-15);
    assert_false(matrix3_invert(singular, inverse));
    const double shear[] = {1, 2, 0, 0, 1, 0, 0, 0, 1}, turn[] = {0, 0, 1, 1, 0, 0, 0, 1, 0};
    const double both[] = {2, 0, 1, 1, 0, 0, 0, 1, 0};
    matrix3_multiply(shear, turn, product);
    assert_matrix(product, both, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(published_matrices), cmocka_unit_test(inverse_and_product)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
