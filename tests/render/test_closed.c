/* Which meshes bound a volume: every edge gone along as often one way as the other. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "render/world/media.h"
#include "scene/scene.h"
#include "tests/render/scenes.h"

/* Two tetrahedra with vertices of their own, the second beside the first, and the base of the first once more. */
static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 0, 0, 6, 0, 0, 5, 1, 0, 5, 0, 1,
                                  0, 0, 0, 1, 0, 0, 0, 1, 0};
#define FIRST 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3
#define SECOND 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7

/* The open edges of some of the triangles, with a material each where materials is not NULL. */
static size_t open_edges(const uint32_t *corners, uint32_t triangles, const kiln_id *materials, kiln_id material) {
    size_t edges;
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(1, 1, 1);
    add_material(&b, &m), add_material(&b, &m);
    kiln_id mesh = add_mesh(&b, &(kiln_mesh_desc){.name = "mesh", .vertex_count = 11, .positions = positions,
                                                  .face_count = triangles, .face_vertices = corners, .material = 1,
                                                  .face_materials = materials});
    bool open = mesh_is_open(scene_mesh(b.scene, mesh), material, &edges);
    assert_true(open == (edges > 0));
    builder_free(&b);
    return edges;
}

static void shells_are_closed(void **state) {
    (void)state;
    assert_int_equal(open_edges((const uint32_t[]){FIRST}, 4, NULL, 1), 0);
    assert_int_equal(open_edges((const uint32_t[]){FIRST, SECOND}, 8, NULL, 1), 0);
}

/* Vertices are one where they lie at one place: a seam of normals or texture coordinates is no hole. */
static void seams_are_no_holes(void **state) {
    (void)state;
    assert_int_equal(open_edges((const uint32_t[]){8, 10, 9, 0, 1, 3, 1, 2, 3, 2, 0, 3}, 4, NULL, 1), 0);
}

static void holes_are_seen(void **state) {
    (void)state;
    assert_int_equal(open_edges((const uint32_t[]){0, 1, 3, 1, 2, 3, 2, 0, 3}, 3, NULL, 1), 3);
    assert_int_equal(open_edges((const uint32_t[]){FIRST, 4, 6, 5}, 5, NULL, 1), 3);
}

/* A face that is turned over goes along its edges as its neighbours do. */
static void turned_faces_are_holes(void **state) {
    (void)state;
    assert_int_equal(open_edges((const uint32_t[]){0, 1, 2, 0, 1, 3, 1, 2, 3, 2, 0, 3}, 4, NULL, 1), 6);
}

/* What is entered twice there is left once. A sheet with a back is closed, and has nothing in it. */
static void doubled_faces_are_holes(void **state) {
    (void)state;
    assert_int_equal(open_edges((const uint32_t[]){FIRST, 0, 2, 1}, 5, NULL, 1), 3);
    assert_int_equal(open_edges((const uint32_t[]){0, 1, 2, 8, 10, 9}, 2, NULL, 1), 0);
}

/* A triangle without area has edges that cancel, or none. */
static void slivers_are_no_holes(void **state) {
    (void)state;
    assert_int_equal(open_edges((const uint32_t[]){FIRST, 0, 1, 8, 3, 3, 3}, 6, NULL, 1), 0);
}

/* Each material must be closed by itself. */
static void materials_are_looked_at_one_by_one(void **state) {
    (void)state;
    const uint32_t both[] = {FIRST, SECOND};
    assert_int_equal(open_edges(both, 8, (const kiln_id[]){1, 1, 1, 1, 2, 2, 2, 2}, 1), 0);
    assert_int_equal(open_edges(both, 8, (const kiln_id[]){1, 1, 1, 1, 2, 2, 2, 1}, 2), 3);
    assert_int_equal(open_edges(both, 8, (const kiln_id[]){1, 1, 1, 1, 2, 2, 2, 1}, 1), 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shells_are_closed),       cmocka_unit_test(seams_are_no_holes),
        cmocka_unit_test(holes_are_seen),          cmocka_unit_test(turned_faces_are_holes),
        cmocka_unit_test(doubled_faces_are_holes), cmocka_unit_test(slivers_are_no_holes),
        cmocka_unit_test(materials_are_looked_at_one_by_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
