#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "base/mat.h"

static double random_unit(uint32_t n, uint32_t k) { return (double)hash_pair(n, k) / 0x1p31 - 1; }
static dvec3 random_vec(uint32_t n) { return (dvec3){random_unit(n, 1), random_unit(n, 2), random_unit(n, 3)}; }

static mat4 random_affine(uint32_t n) {
    mat4 m = mat4_identity();
    for (uint32_t i = 0; i < 16; i++)
        if (i % 4 != 3) m.m[i] = random_unit(n, 10 + i);
    return m;
}

static void close_to(dvec3 a, dvec3 b, double tolerance) {
    double distance = d3_length(d3_sub(a, b));
    if (!(distance <= tolerance)) fail_msg("(%g %g %g) and (%g %g %g)", a.x, a.y, a.z, b.x, b.y, b.z);
}

static void columns_are_the_images_of_the_axes(void **state) {
    (void)state;
    const double m[16] = {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 20, 30, 40, 1};
    mat4 a = mat4_load(m);
    close_to(mat4_vector(&a, (dvec3){1, 0, 0}), (dvec3){1, 2, 3}, 0);
    close_to(mat4_point(&a, (dvec3){0, 0, 0}), (dvec3){20, 30, 40}, 0);
    close_to(mat4_point(&a, (dvec3){1, 1, 1}), (dvec3){32, 45, 59}, 0);
    assert_true(mat4_determinant(&a) == -3);
}

static void products_apply_the_right_one_first(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 1000; n++) {
        mat4 a = random_affine(2 * n), b = random_affine(2 * n + 1), ab = mat4_mul(a, b);
        dvec3 p = random_vec(n);
        close_to(mat4_point(&ab, p), mat4_point(&a, mat4_point(&b, p)), 1e-13);
        close_to(mat4_vector(&ab, p), mat4_vector(&a, mat4_vector(&b, p)), 1e-13);
        assert_true(ab.m[3] == 0 && ab.m[7] == 0 && ab.m[11] == 0 && ab.m[15] == 1);
    }
}

static void inverses_undo(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 1000; n++) {
        mat4 a = random_affine(n), inverse = mat4_identity();
        dvec3 p = random_vec(n);
        double det = mat4_determinant(&a);
        assert_true(mat4_invert(&a, &inverse));
        close_to(mat4_point(&inverse, mat4_point(&a, p)), p, 1e-13 / fabs(det));
    }
    mat4 flat = mat4_identity(), tiny = mat4_identity(), nan = mat4_identity(), inverse = flat;
    flat.m[10] = 0;
    assert_false(mat4_invert(&flat, &inverse));
    tiny.m[0] = tiny.m[5] = tiny.m[10] = 1e-30; /* 1e-90 is no zero */
    assert_true(mat4_invert(&tiny, &inverse) && fabs(inverse.m[0] * 1e-30 - 1) < 1e-14);
    tiny.m[0] = tiny.m[5] = tiny.m[10] = 1e-120; /* but 1e-360 is */
    assert_false(mat4_invert(&tiny, &inverse));
    nan.m[5] = (double)NAN;
    assert_false(mat4_invert(&nan, &inverse));
}

/* A normal stays perpendicular to the surface's tangents, and on the side from which the triangle is seen
 * counter-clockwise: also when the transform shears, mirrors or flattens. */
static void normals_follow_the_surface(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 1000; n++) {
        mat4 m = random_affine(n);
        dvec3 u = random_vec(2 * n), v = random_vec(2 * n + 1);
        close_to(mat4_normal(&m, d3_cross(u, v)), d3_cross(mat4_vector(&m, u), mat4_vector(&m, v)), 1e-12);
    }
    mat4 flatten = mat4_identity();
    flatten.m[10] = 0;
    close_to(mat4_normal(&flatten, (dvec3){0, 0, 1}), (dvec3){0, 0, 1}, 0);
}

static void translation_rotation_scale(void **state) {
    (void)state;
    const double half = sqrt(0.5), t[3] = {10, 20, 30}, quarter_about_z[4] = {0, 0, half, half}, s[3] = {2, 3, -4};
    mat4 m = mat4_trs(t, quarter_about_z, s);
    close_to(mat4_point(&m, (dvec3){1, 0, 0}), (dvec3){10, 22, 30}, 1e-14);
    close_to(mat4_point(&m, (dvec3){0, 1, 0}), (dvec3){7, 20, 30}, 1e-14);
    close_to(mat4_point(&m, (dvec3){0, 0, 1}), (dvec3){10, 20, 26}, 1e-14);
    assert_true(fabs(mat4_determinant(&m) + 24) < 1e-13);
    /* Files hold quaternions of any length, and of none. */
    const double longer[4] = {0, 0, 3, 3}, none[4] = {0};
    m = mat4_trs(t, longer, s);
    close_to(mat4_point(&m, (dvec3){1, 0, 0}), (dvec3){10, 22, 30}, 1e-14);
    m = mat4_trs(t, none, s);
    close_to(mat4_point(&m, (dvec3){1, 0, 0}), (dvec3){12, 20, 30}, 0);
    /* Any rotation keeps lengths and handedness. */
    for (uint32_t n = 0; n < 1000; n++) {
        double q[4], length = 0;
        for (uint32_t i = 0; i < 4; i++) q[i] = random_unit(n, i), length += q[i] * q[i];
        for (int i = 0; i < 4; i++) q[i] /= sqrt(length);
        mat4 r = mat4_trs((const double[]){0, 0, 0}, q, (const double[]){1, 1, 1});
        dvec3 p = random_vec(n);
        assert_true(fabs(d3_length(mat4_vector(&r, p)) - d3_length(p)) < 1e-14 &&
                    fabs(mat4_determinant(&r) - 1) < 1e-14);
    }
}

static void vectors(void **state) {
    (void)state;
    close_to(d3_normalize((dvec3){0, 0, 0}), (dvec3){0, 0, 0}, 0);
    close_to(d3_normalize((dvec3){0, -3, 4}), (dvec3){0, -0.6, 0.8}, 1e-15);
    close_to(d3_cross((dvec3){1, 0, 0}, (dvec3){0, 1, 0}), (dvec3){0, 0, 1}, 0);
    assert_true(d3_dot((dvec3){1, 2, 3}, (dvec3){4, -5, 6}) == 12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_are_the_images_of_the_axes),
        cmocka_unit_test(products_apply_the_right_one_first),
        cmocka_unit_test(inverses_undo),
        cmocka_unit_test(normals_follow_the_surface),
        cmocka_unit_test(translation_rotation_scale),
        cmocka_unit_test(vectors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
