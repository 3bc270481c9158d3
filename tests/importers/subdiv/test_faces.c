#include "tests/importers/subdiv/support.h"

#include <math.h>
#include <string.h>

#include "importers/subdiv/faces.h"

static const kiln_mesh *add(fixture *f, const kiln_mesh_desc *desc) {
    kiln_id id;
    assert_true(kiln_scene_add_mesh(f->scene, desc, &id, f->report));
    return scene_mesh(f->scene, id);
}

/* Two triangles that share an edge by position alone; -0 is 0, and a vertex that nothing uses is left out. */
static void welds_by_position_bits(void **state) {
    fixture *f = *state;
    float p[21] = {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0, -0.0f, 1, 0, 1, 0, -0.0f, 1, 1, 0};
    const uint32_t corners[6] = {1, 2, 3, 4, 5, 6};
    kiln_mesh_desc desc = {.vertex_count = 7, .positions = p, .face_count = 2, .face_vertices = corners};
    vertex_weld w;
    assert_true(weld_vertices(add(f, &desc), true, &f->arena, &w));
    assert_int_equal(w.count, 4);
    assert_int_equal(w.map[0], EDGE_NONE);
    assert_int_equal(w.map[3], w.map[4]);
    assert_int_equal(w.map[2], w.map[5]);
    assert_int_equal(w.sources[w.map[5]], 2);
    assert_true(weld_vertices(add(f, &desc), false, &f->arena, &w));
    assert_int_equal(w.count, 6);
    p[13] = nextafterf(1, 2); /* exact bits: a neighbour is another point */
    assert_true(weld_vertices(add(f, &desc), true, &f->arena, &w));
    assert_int_equal(w.count, 5);
}

static void points_that_part_later_are_two(void **state) {
    fixture *f = *state;
    float p[36] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0};
    memcpy(p + 18, p, 18 * sizeof *p);
    p[18 + 9] = -1; /* vertex 3 leaves vertex 2 at the second time */
    const uint32_t corners[6] = {0, 1, 2, 3, 4, 5};
    kiln_mesh_desc desc = {.vertex_count = 6, .time_count = 2, .positions = p, .face_count = 2,
                           .face_vertices = corners};
    vertex_weld w;
    assert_true(weld_vertices(add(f, &desc), true, &f->arena, &w));
    assert_int_equal(w.count, 5);
}

static void triangles_without_area_go(void **state) {
    fixture *f = *state;
    const float p[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0};
    const uint32_t corners[9] = {0, 1, 2, 1, 3, 2, 2, 1, 0};
    kiln_mesh_desc desc = {.vertex_count = 4, .positions = p, .face_count = 3, .face_vertices = corners};
    const kiln_mesh *m = add(f, &desc);
    vertex_weld w;
    face_list faces;
    assert_true(weld_vertices(m, true, &f->arena, &w) && faces_take(m, &w, true, &f->arena, &faces));
    assert_int_equal(faces.face_count, 2);
    assert_int_equal(faces.sources[1], 2);
    assert_int_equal(faces.corners[3], 6);
    assert_true(faces_take(m, &w, false, &f->arena, &faces));
    assert_int_equal(faces.face_count, 3);
}

static void fans_become_polygons(void **state) {
    fixture *f = *state;
    float p[27] = {0};
    for (int i = 0; i < 9; i++) p[3 * i] = cosf((float)i), p[3 * i + 1] = sinf((float)i), p[3 * i + 2] = (float)i;
    /* a pentagon at 0, a quad at 4, two fans at 7 that do not chain up */
    const uint32_t corners[21] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 4, 5, 6, 4, 6, 7, 7, 8, 0, 7, 1, 2};
    kiln_mesh_desc desc = {.vertex_count = 9, .positions = p, .face_count = 7, .face_vertices = corners};
    const kiln_mesh *m = add(f, &desc);
    vertex_weld w;
    face_list faces;
    assert_true(weld_vertices(m, true, &f->arena, &w) && faces_join_fans(m, &w, &f->arena, &faces));
    assert_int_equal(faces.face_count, 4);
    assert_memory_equal(faces.sizes, ((uint32_t[4]){5, 4, 3, 3}), sizeof(uint32_t[4]));
    assert_memory_equal(faces.corners, ((uint32_t[5]){0, 1, 2, 5, 8}), sizeof(uint32_t[5]));
    assert_memory_equal(faces.sources, ((uint32_t[4]){0, 3, 5, 6}), sizeof(uint32_t[4]));
}

typedef struct paired {
    face_list faces;
    double rate;
} paired;

static paired pair(fixture *f, const kiln_mesh_desc *desc, uint32_t keep_a, uint32_t keep_b) {
    const kiln_mesh *m = add(f, desc);
    vertex_weld w;
    face_list triangles;
    edge_table edges;
    paired result;
    assert_true(weld_vertices(m, true, &f->arena, &w) && faces_take(m, &w, true, &f->arena, &triangles));
    polygons p = faces_polygons(&triangles, &w);
    assert_true(edges_build(&p, &f->arena, &edges));
    uint8_t *keep = ARENA_ARRAY(&f->arena, uint8_t, edges.count);
    if (keep_a != keep_b) keep[edges_find(&edges, w.map[keep_a], w.map[keep_b])] = 1;
    assert_true(faces_pair(m, &w, &triangles, &edges, keep, &f->arena, &result.faces, &result.rate));
    return result;
}

static void exported_quads_come_back(void **state) {
    fixture *f = *state;
    shape quads, triangles;
    shape_quad_sphere(&quads, 6, 1);
    shape_export(&triangles, &quads);
    paired p = pair(f, &triangles.desc, 0, 0);
    assert_true(p.rate == 1);
    assert_int_equal(p.faces.face_count, quads.desc.face_count);
    for (uint32_t q = 0; q < p.faces.face_count; q++) { /* the same four positions */
        double sum[3] = {0};
        for (uint32_t k = 0; k < 4; k++)
            for (uint32_t c = 0; c < 3; c++) {
                uint32_t there = quads.desc.face_vertices[4 * q + k];
                uint32_t here = triangles.desc.face_vertices[p.faces.corners[4 * q + k]];
                sum[c] += (double)quads.desc.positions[3 * there + c] - (double)triangles.desc.positions[3 * here + c];
            }
        assert_true(sum[0] == 0 && sum[1] == 0 && sum[2] == 0);
    }
    shape_free(&quads);
    shape_free(&triangles);
}

/* A row of three quads between two lone triangles, each of which would pair with the half of a quad beside it. */
static void lone_triangles_shift_nothing(void **state) {
    fixture *f = *state;
    const float p[30] = {0, 0, 0, 0, 1, 0, -.6f, .5f, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0, 3, 0, 0, 3, 1, 0,
                         3.6f, .5f, 0};
    const uint32_t corners[24] = {0, 1, 2, 0, 3, 1, 3, 4, 1, 3, 5, 4, 5, 6, 4, 5, 7, 6, 7, 8, 6, 7, 9, 8};
    kiln_mesh_desc desc = {.vertex_count = 10, .positions = p, .face_count = 8, .face_vertices = corners};
    paired both = pair(f, &desc, 0, 0);
    assert_memory_equal(both.faces.sizes, ((uint32_t[5]){3, 4, 4, 4, 3}), sizeof(uint32_t[5]));
    assert_memory_equal(both.faces.sources, ((uint32_t[5]){0, 1, 3, 5, 7}), sizeof(uint32_t[5]));
    assert_true(both.faces.face_count == 5 && both.rate == 0.75);
    desc.face_count = 7;
    paired first = pair(f, &desc, 0, 0);
    assert_memory_equal(first.faces.sizes, ((uint32_t[4]){3, 4, 4, 4}), sizeof(uint32_t[4]));
    desc.face_vertices = corners + 3;
    paired last = pair(f, &desc, 0, 0);
    assert_memory_equal(last.faces.sizes, ((uint32_t[4]){4, 4, 4, 3}), sizeof(uint32_t[4]));
}

/* Two triangles may also make an arrowhead, or a larger triangle. */
static void quads_are_convex(void **state) {
    fixture *f = *state;
    for (int i = 0; i < 3; i++) {
        float y = i == 0 ? -.5f : i == 1 ? 0 : .5f;
        const float p[12] = {0, 0, 0, 1, y, 0, 0, 1, 0, -1, y, 0};
        const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
        kiln_mesh_desc desc = {.vertex_count = 4, .positions = p, .face_count = 2, .face_vertices = corners};
        assert_true(pair(f, &desc, 0, 0).rate == (i == 2 ? 1.0 : 0.0));
    }
}

/* One quad of two triangles on the diagonal 0–2, with a bend along it and values to taste. */
static double rate_of_quad(fixture *f, float bend, float x3, const kiln_primvar *primvar, const kiln_id *materials,
                           bool crease) {
    const float p[18] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, x3, 1, bend};
    const uint32_t corners[6] = {0, 1, 2, 3, 4, 5};
    kiln_mesh_desc desc = {.vertex_count = 6, .positions = p, .face_count = 2, .face_vertices = corners,
                           .primvars = primvar, .primvar_count = primvar ? 1 : 0, .face_materials = materials};
    return pair(f, &desc, 0, crease ? 2 : 0).rate;
}

static void what_was_no_quad_stays_apart(void **state) {
    fixture *f = *state;
    kiln_material material = kiln_material_default();
    assert_true(kiln_scene_add_material(f->scene, &material, NULL, f->report));
    assert_true(kiln_scene_add_material(f->scene, &material, NULL, f->report));
    const float same[12] = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1}, seam[12] = {0, 0, 1, 0, 1, 1, 0, 0, .5f, 1, 0, 1};
    const kiln_primvar uv_same = {KILN_PRIMVAR_UV, 0, KILN_VERTEX, same, 6, NULL};
    const kiln_primvar uv_seam = {KILN_PRIMVAR_UV, 0, KILN_VERTEX, seam, 6, NULL};
    const float frames[24] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
    const kiln_primvar tangents = {KILN_PRIMVAR_TANGENT, 0, KILN_VERTEX, frames, 6, NULL};
    assert_true(rate_of_quad(f, 0, 0, NULL, NULL, false) == 1);
    assert_true(rate_of_quad(f, 0, 0, &uv_same, NULL, false) == 1);
    assert_true(rate_of_quad(f, 0, 0, &tangents, NULL, false) == 1); /* made per triangle: they say nothing */
    assert_true(rate_of_quad(f, 0, 0, &uv_seam, NULL, false) == 0);
    assert_true(rate_of_quad(f, 0, 0, NULL, (kiln_id[2]){1, 1}, false) == 1);
    assert_true(rate_of_quad(f, 0, 0, NULL, (kiln_id[2]){1, 2}, false) == 0);
    assert_true(rate_of_quad(f, 0, 0, NULL, NULL, true) == 0);
    assert_true(rate_of_quad(f, .5f, 0, NULL, NULL, false) == 1);
    assert_true(rate_of_quad(f, 2, 0, NULL, NULL, false) == 0);   /* bent by 71° */
    assert_true(rate_of_quad(f, 0, 2, NULL, NULL, false) == 0);   /* folded over */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(welds_by_position_bits, setup, teardown),
        cmocka_unit_test_setup_teardown(points_that_part_later_are_two, setup, teardown),
        cmocka_unit_test_setup_teardown(triangles_without_area_go, setup, teardown),
        cmocka_unit_test_setup_teardown(fans_become_polygons, setup, teardown),
        cmocka_unit_test_setup_teardown(exported_quads_come_back, setup, teardown),
        cmocka_unit_test_setup_teardown(lone_triangles_shift_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(quads_are_convex, setup, teardown),
        cmocka_unit_test_setup_teardown(what_was_no_quad_stays_apart, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
