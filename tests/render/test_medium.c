/* The stack of media, and what they take. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render/path/medium.h"

static uint32_t innermost(uint64_t media) { return (uint32_t)(media & 0xffff); }

static void media_nest(void **state) {
    (void)state;
    uint64_t m = 0;
    for (uint32_t i = 1; i <= 4; i++) {
        m = medium_cross(m, i, 1);
        assert_int_equal(innermost(m), i);
    }
    for (uint32_t i = 4; i >= 1; i--) {
        assert_int_equal(innermost(m), i);
        m = medium_cross(m, i, 0);
    }
    assert_int_equal(m, 0);
}

/* Solids that overlap are left in any order: each takes itself out, and the others keep theirs. */
static void media_are_left_in_any_order(void **state) {
    (void)state;
    static const uint32_t orders[][4] = {{1, 2, 3, 4}, {4, 3, 2, 1}, {2, 4, 1, 3}, {3, 1, 4, 2}};
    for (int o = 0; o < 4; o++) {
        uint64_t m = 0;
        int inside[5] = {0};
        for (uint32_t i = 1; i <= 4; i++) m = medium_enter(m, i), inside[i] = 1;
        for (int k = 0; k < 4; k++) {
            m = medium_leave(m, orders[o][k]);
            inside[orders[o][k]] = 0;
            uint32_t expected = 0;
            for (uint32_t i = 1; i <= 4; i++)
                if (inside[i]) expected = i; /* entered last */
            assert_int_equal(innermost(m), expected);
        }
        assert_int_equal(m, 0);
    }
}

/* The same medium twice is left once at a time, the innermost first. */
static void a_medium_may_be_entered_twice(void **state) {
    (void)state;
    uint64_t m = medium_enter(medium_enter(medium_enter(0, 7), 9), 7);
    m = medium_leave(m, 7);
    assert_int_equal(innermost(m), 9);
    assert_int_equal(m, medium_enter(medium_enter(0, 7), 9));
    m = medium_leave(medium_leave(m, 9), 7);
    assert_int_equal(m, 0);
}

/* More than four: the outermost is forgotten, and leaving it later changes nothing. */
static void overflow_forgets_the_outermost(void **state) {
    (void)state;
    uint64_t m = 0;
    for (uint32_t i = 1; i <= 6; i++) m = medium_enter(m, 0xfff0 + i);
    for (uint32_t i = 6; i >= 3; i--) {
        assert_int_equal(innermost(m), 0xfff0 + i);
        m = medium_leave(m, 0xfff0 + i);
    }
    assert_int_equal(m, 0);
    assert_int_equal(medium_leave(m, 0xfff2), 0);
}

/* What was never entered (an open mesh) cannot be left; surfaces without a medium change nothing. */
static void absent_media_change_nothing(void **state) {
    (void)state;
    uint64_t m = medium_enter(medium_enter(0, 3), 4);
    assert_int_equal(medium_leave(m, 5), m);
    assert_int_equal(medium_leave(0, 5), 0);
    assert_int_equal(medium_cross(m, 0, 1), m);
    assert_int_equal(medium_cross(m, 0, 0), m);
}

static void transmittance_is_exponential(void **state) {
    (void)state;
    const float sigma[6] = {9, 9, 9, 0, 0.5f, 3};
    for (float d = 0; d < 20; d += 0.25f) {
        vec3 t = medium_transmittance(sigma, 1, d);
        assert_true(t.x == 1);
        assert_true(fabs((double)t.y - exp(-0.5 * (double)d)) < 1e-6 && fabs((double)t.z - exp(-3 * (double)d)) < 1e-6);
    }
    /* A ray that leaves the scene from inside has met an open mesh: it loses nothing, and makes no NaN of 0 · ∞. */
    vec3 t = medium_transmittance(sigma, 1, INFINITY);
    assert_true(t.x == 1 && t.y == 1 && t.z == 1);
    assert_true(medium_transmittance((const float[]){1e30f, 0, 0}, 0, 1e30f).x == 0);
}

/* The extension's definition: n_d at the d line, (n_d − 1)/V between the F and the C line. */
static void index_is_cauchys(void **state) {
    (void)state;
    const float ior = 1.5168f, abbe = 64.17f;
    world_medium m = {.ior = ior, .spread = (ior - 1) / abbe};
    assert_true(fabsf(medium_ior(&m, 587.6f) - ior) < 2e-6f);
    assert_true(fabsf(medium_ior(&m, 486.1f) - medium_ior(&m, 656.3f) - (ior - 1) / abbe) < 5e-6f);
    m.spread = 5;
    assert_true(medium_ior(&m, 780) == 1 && medium_ior(&m, 380) <= WORLD_IOR_MAX);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(media_nest),                   cmocka_unit_test(media_are_left_in_any_order),
        cmocka_unit_test(a_medium_may_be_entered_twice), cmocka_unit_test(overflow_forgets_the_outermost),
        cmocka_unit_test(absent_media_change_nothing),  cmocka_unit_test(transmittance_is_exponential),
        cmocka_unit_test(index_is_cauchys),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
