#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "base/vec.h"

static int equal(vec3 a, vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
static vec3 random_vec(uint32_t n) {
    return v3(unit_float(hash_pair(n, 0)) * 2 - 1, unit_float(hash_pair(n, 1)) * 2 - 1,
              unit_float(hash_pair(n, 2)) * 2 - 1);
}

static void arithmetic(void **state) {
    (void)state;
    const vec3 a = v3(1, 2, 3), b = v3(4, -5, 6);
    assert_true(equal(v3_add(a, b), v3(5, -3, 9)) && equal(v3_sub(a, b), v3(-3, 7, -3)));
    assert_true(equal(v3_mul(a, b), v3(4, -10, 18)) && equal(v3_scale(a, 2), v3(2, 4, 6)));
    assert_true(equal(v3_neg(a), v3(-1, -2, -3)) && equal(v3_madd(a, 2, b), v3(9, -8, 15)));
    assert_true(equal(v3_lerp(a, b, 0.5f), v3(2.5f, -1.5f, 4.5f)) && equal(v3_abs(b), v3(4, 5, 6)));
    assert_true(equal(v3_splat(7), v3(7, 7, 7)));
    assert_true(v3_max(a) == 3 && v3_max(v3(9, 2, 3)) == 9 && v3_max(v3(1, 8, 3)) == 8);
    assert_true(equal(v3_select(1, a, b), a) && equal(v3_select(0, a, b), b));
    assert_true(equal(v3_transform((float[]){0, 1, 0, 0, 0, 2, 3, 0, 1}, a), v3(2, 6, 6)));
    float memory[3];
    v3_store(memory, b);
    assert_true(equal(v3_load(memory), b));
}

static void products(void **state) {
    (void)state;
    assert_true(v3_dot(v3(1, 2, 3), v3(4, -5, 6)) == 12);
    assert_true(equal(v3_cross(v3(1, 0, 0), v3(0, 1, 0)), v3(0, 0, 1))); /* right-handed */
    assert_true(equal(v3_cross(v3(1, 2, 3), v3(4, -5, 6)), v3(27, 6, -13)));
    assert_true(v3_length(v3(2, 3, 6)) == 7);
    for (uint32_t n = 0; n < 10000; n++) {
        vec3 a = random_vec(2 * n), b = random_vec(2 * n + 1), c = v3_cross(a, b), u = v3_normalize(a);
        assert_true(fabsf(v3_dot(a, c)) < 1e-6f && fabsf(v3_dot(b, c)) < 1e-6f);
        assert_true(fabsf(v3_length(u) - 1) < 2e-7f && fabsf(v3_dot(u, a) - v3_length(a)) < 1e-6f);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(arithmetic), cmocka_unit_test(products)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
