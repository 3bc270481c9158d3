#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "importers/mesh/topology.h"

static void welds_equal_numbers(void **state) {
    (void)state;
    const float nan = NAN;
    const float positions[] = {0, 0, 0, 1, 0, 0, -0.0f, 0, -0.0f, nan, 1, 2, nan, 1, 2, 1, 0, 0};
    const float uvs[] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.5f, 0};
    const corner_stream streams[] = {{positions, 3}, {uvs, 2}};
    uint32_t ids[6], count;
    assert_true(topology_weld(streams, 1, 6, ids, &count));
    const uint32_t by_position[] = {0, 1, 0, 2, 2, 1};
    assert_memory_equal(ids, by_position, sizeof ids);
    assert_int_equal(count, 3);
    assert_true(topology_weld(streams, 2, 6, ids, &count));
    const uint32_t by_both[] = {0, 1, 0, 2, 2, 3};
    assert_memory_equal(ids, by_both, sizeof ids);
    assert_int_equal(count, 4);
    assert_true(topology_weld(streams, 2, 0, ids, &count));
    assert_int_equal(count, 0);
}

static void pairs_opposite_edges(void **state) {
    (void)state;
    /* Two triangles with the diagonal 0–2, then two more on it: a third that runs as the first does, and one that
     * runs as the second; then a triangle that is left out. */
    const uint32_t ids[] = {0, 1, 2, 0, 2, 3, 4, 2, 0, 5, 0, 2, 2, 1, 6};
    const uint8_t skip[] = {0, 0, 0, 0, 1};
    uint32_t twins[15];
    assert_true(topology_twins(ids, 5, skip, twins));
    assert_int_equal(twins[2], 3); /* 2→0 and 0→2 */
    assert_int_equal(twins[3], 2);
    assert_int_equal(twins[7], 10); /* first come, first served */
    assert_int_equal(twins[10], 7);
    assert_int_equal(twins[1], TOPOLOGY_NO_TWIN); /* its only partner is left out */
    assert_int_equal(twins[12], TOPOLOGY_NO_TWIN);
    for (uint32_t c = 0; c < 15; c++)
        if (twins[c] != TOPOLOGY_NO_TWIN) assert_int_equal(twins[twins[c]], c);
}

/* 300,000 triangles on one edge, one way first, then the other: quadratic work would not end. */
static void survives_a_hub(void **state) {
    (void)state;
    enum { COUNT = 300000 };
    uint32_t *ids = calloc(3 * COUNT, sizeof *ids), *twins = calloc(3 * COUNT, sizeof *twins);
    uint8_t *skip = calloc(COUNT, 1);
    for (uint32_t t = 0; t < COUNT; t++) {
        ids[3 * t] = t < COUNT / 2 ? 0 : 1;
        ids[3 * t + 1] = t < COUNT / 2 ? 1 : 0;
        ids[3 * t + 2] = 2 + t;
    }
    assert_true(topology_twins(ids, COUNT, skip, twins));
    for (uint32_t t = 0; t < COUNT / 2; t++) assert_int_equal(twins[3 * t], 3 * (t + COUNT / 2));
    free(ids);
    free(twins);
    free(skip);
}

static void numbers_groups(void **state) {
    (void)state;
    uint32_t *groups = topology_groups_create(7);
    topology_groups_join(groups, 6, 3);
    topology_groups_join(groups, 1, 2);
    topology_groups_join(groups, 5, 6);
    topology_groups_join(groups, 2, 5);
    assert_int_equal(topology_groups_number(groups, 7), 3);
    const uint32_t expected[] = {0, 1, 1, 1, 2, 1, 1};
    assert_memory_equal(groups, expected, sizeof expected);
    free(groups);
}

static void angles_and_perpendiculars(void **state) {
    (void)state;
    assert_true(corner_angle((dvec3){0, 0, 0}, (dvec3){1, 0, 0}) == 0);
    assert_true(fabs(corner_angle((dvec3){1e-30, 0, 0}, (dvec3){-3, 0, 0}) - acos(-1)) < 1e-15);
    assert_true(fabs(corner_angle((dvec3){2, 0, 0}, (dvec3){0, 1e30, 0}) - acos(0)) < 1e-15);
    const dvec3 normals[] = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.6, 0, 0.8}};
    for (size_t i = 0; i < sizeof normals / sizeof *normals; i++) {
        dvec3 p = corner_perpendicular(normals[i]);
        assert_true(fabs(d3_length(p) - 1) < 1e-12 && fabs(d3_dot(p, normals[i])) < 1e-12);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(welds_equal_numbers),
        cmocka_unit_test(pairs_opposite_edges),
        cmocka_unit_test(survives_a_hub),
        cmocka_unit_test(numbers_groups),
        cmocka_unit_test(angles_and_perpendiculars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
