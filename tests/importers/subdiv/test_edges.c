#include "tests/importers/subdiv/shapes.h"

#include "importers/subdiv/edges.h"

static edge_table build(const polygons *p, kiln_arena *arena) {
    edge_table table;
    assert_true(edges_build(p, arena, &table));
    return table;
}

static void a_cube_has_twelve(void **state) {
    (void)state;
    shape s;
    shape_cube(&s);
    kiln_arena arena = {0};
    polygons p = {8, 6, 24, s.desc.face_sizes, s.desc.face_vertices};
    edge_table t = build(&p, &arena);
    assert_int_equal(t.count, 12);
    for (uint32_t e = 0; e < 12; e++) {
        const polygon_edge *edge = &t.edges[e];
        assert_int_equal(edge->uses, 2);
        assert_true(edge->vertices[0] < edge->vertices[1]);
        assert_true(edge_is_regular(edge, p.face_vertices));
        assert_int_equal(edges_find(&t, edge->vertices[0], edge->vertices[1]), e);
        assert_int_equal(edges_find(&t, edge->vertices[1], edge->vertices[0]), e);
        for (int k = 0; k < 2; k++) assert_int_equal(t.corner_edges[edge->corners[k]], e);
    }
    for (uint32_t c = 0; c < 24; c++) {
        uint32_t a = p.face_vertices[c], b = p.face_vertices[c % 4 == 3 ? c - 3 : c + 1];
        assert_int_equal(t.corner_edges[c], edges_find(&t, a, b));
    }
    assert_int_equal(edges_find(&t, 0, 3), EDGE_NONE); /* a face's diagonal */
    assert_int_equal(edges_find(&t, 7, 7), EDGE_NONE);
    arena_free(&arena);
}

static void fins_boundaries_and_flips_are_seen(void **state) {
    (void)state;
    const uint32_t corners[12] = {0, 1, 2, 1, 0, 3, 0, 1, 4, 1, 2, 5}; /* three on edge 0-1; the last is flipped */
    kiln_arena arena = {0};
    polygons p = {6, 4, 12, NULL, corners};
    edge_table t = build(&p, &arena);
    assert_int_equal(t.count, 9);
    const polygon_edge *fin = &t.edges[edges_find(&t, 0, 1)], *flip = &t.edges[edges_find(&t, 2, 1)];
    assert_int_equal(fin->uses, 3);
    assert_int_equal(fin->corners[0], 0);
    assert_int_equal(fin->corners[1], 3);
    assert_int_equal(flip->uses, 2);
    assert_false(edge_is_regular(flip, corners));
    assert_int_equal(t.edges[edges_find(&t, 0, 4)].corners[1], EDGE_NONE);
    arena_free(&arena);
}

static void nothing_and_points_on_themselves(void **state) {
    (void)state;
    kiln_arena arena = {0};
    polygons none = {0};
    assert_int_equal(build(&none, &arena).count, 0);
    const uint32_t corners[3] = {1, 1, 1};
    polygons p = {2, 1, 3, NULL, corners};
    edge_table t = build(&p, &arena);
    assert_int_equal(t.count, 1);
    assert_int_equal(t.edges[0].uses, 3);
    assert_int_equal(edges_find(&t, 0, 1), EDGE_NONE);
    arena_free(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_cube_has_twelve),
                                       cmocka_unit_test(fins_boundaries_and_flips_are_seen),
                                       cmocka_unit_test(nothing_and_points_on_themselves)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
