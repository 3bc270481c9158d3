#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "importers/mesh/complete.h"

/* A roof: two quads that meet at a ridge, and an L of six corners in the ground, all with planar uvs. */
static const float positions[] = {0, 0, 0, 0, 0, 2, 1, 1, 2, 1, 1, 0, 2, 0, 2, 2, 0, 0,
                                  4, 0, 0, 6, 0, 0, 6, 0, 1, 5, 0, 1, 5, 0, 2, 4, 0, 2};
static const uint32_t face_sizes[] = {4, 4, 6};
static const uint32_t face_vertices[] = {0, 1, 2, 3, 3, 2, 4, 5, 11, 10, 9, 8, 7, 6};
static const float uvs[] = {0, 0, 0, 2, 1, 2, 1, 0, 2, 2, 2, 0, 4, 0, 6, 0, 6, 1, 5, 1, 5, 2, 4, 2};
static const kiln_primvar uv0 = {
    .kind = KILN_PRIMVAR_UV, .interpolation = KILN_VERTEX, .values = uvs, .value_count = 12};

static kiln_mesh_desc roof(void) {
    return (kiln_mesh_desc){.name = "roof", .vertex_count = 12, .positions = positions, .face_count = 3,
                            .face_sizes = face_sizes, .face_vertices = face_vertices, .primvars = &uv0,
                            .primvar_count = 1};
}

static const kiln_primvar *last(const kiln_mesh_desc *m) { return &m->primvars[m->primvar_count - 1]; }

static void near(const float *v, double x, double y, double z) {
    if (fabs(v[0] - x) > 1e-6 || fabs(v[1] - y) > 1e-6 || fabs(v[2] - z) > 1e-6)
        fail_msg("(%g %g %g) is not (%g %g %g)", (double)v[0], (double)v[1], (double)v[2], x, y, z);
}

static void flat_normals_of_polygons(void **state) {
    (void)state;
    kiln_arena arena = {0};
    kiln_report *report = kiln_report_create();
    kiln_mesh_desc mesh = roof();
    assert_true(complete_flat_normals(&mesh, &arena, NULL, report));
    assert_int_equal(mesh.primvar_count, 2);
    const kiln_primvar *n = last(&mesh);
    assert_true(n->kind == KILN_PRIMVAR_NORMAL && n->interpolation == KILN_UNIFORM && n->value_count == 3);
    near(n->values, -sqrt(0.5), sqrt(0.5), 0);
    near(n->values + 3, sqrt(0.5), sqrt(0.5), 0);
    near(n->values + 6, 0, 1, 0);
    /* Once more replaces them. */
    assert_true(complete_flat_normals(&mesh, &arena, NULL, report));
    assert_int_equal(mesh.primvar_count, 2);
    arena_free(&arena);
    kiln_report_destroy(report);
}

static void smooth_normals_of_polygons(void **state) {
    (void)state;
    kiln_arena arena = {0};
    kiln_report *report = kiln_report_create();
    kiln_mesh_desc mesh = roof();
    assert_true(complete_smooth_normals(&mesh, 1.6, &arena, NULL, report)); /* the ridge bends by a right angle */
    const kiln_primvar *n = last(&mesh);
    assert_true(n->interpolation == KILN_FACE_VARYING && n->value_count == 14);
    near(n->values, -sqrt(0.5), sqrt(0.5), 0);
    near(n->values + 3 * 2, 0, 1, 0); /* the ridge */
    near(n->values + 3 * 4, 0, 1, 0);
    near(n->values + 3 * 6, sqrt(0.5), sqrt(0.5), 0);
    for (int c = 8; c < 14; c++) near(n->values + 3 * c, 0, 1, 0);
    assert_true(complete_smooth_normals(&mesh, 1.5, &arena, NULL, report));
    near(last(&mesh)->values + 3 * 2, -sqrt(0.5), sqrt(0.5), 0);
    arena_free(&arena);
    kiln_report_destroy(report);
}

static void tangents_of_polygons(void **state) {
    (void)state;
    kiln_arena arena = {0};
    kiln_report *report = kiln_report_create();
    kiln_mesh_desc mesh = roof();
    assert_true(complete_tangents(&mesh, 1, &arena, NULL, report)); /* no such UV set */
    assert_int_equal(mesh.primvar_count, 1);
    assert_true(complete_tangents(&mesh, 0, &arena, NULL, report));
    assert_int_equal(mesh.primvar_count, 3); /* uvs, flat normals, tangents */
    const kiln_primvar *t = last(&mesh);
    assert_true(t->kind == KILN_PRIMVAR_TANGENT && t->interpolation == KILN_FACE_VARYING && t->value_count == 14);
    /* u = x, v = z: seen from above v runs down, so w is +1; the concave L has no corner that turns over. */
    for (int c = 0; c < 14; c++) {
        double slope = c < 4 ? 1 : c < 8 ? -1 : 0, length = c < 8 ? sqrt(2) : 1;
        near(t->values + 4 * c, 1 / length, slope / length, 0);
        assert_true(t->values[4 * c + 3] == 1);
    }
    arena_free(&arena);
    kiln_report_destroy(report);
}

static kiln_scene *scene_with_normal_map(kiln_id *plain, kiln_id *mapped, kiln_report *report) {
    kiln_scene *scene = kiln_scene_create();
    const unsigned char pixel[] = {128, 128, 255};
    kiln_image_desc image = {.pixels = pixel, .width = 1, .height = 1, .channels = 3};
    kiln_material material = kiln_material_default();
    assert_true(kiln_scene_add_material(scene, &material, plain, report));
    assert_true(kiln_scene_add_image(scene, &image, &material.normal.texture.image, report));
    assert_true(kiln_scene_add_material(scene, &material, mapped, report));
    return scene;
}

static void mesh_gets_what_its_materials_need(void **state) {
    (void)state;
    kiln_arena arena = {0};
    kiln_report *report = kiln_report_create();
    kiln_id plain, mapped;
    kiln_scene *scene = scene_with_normal_map(&plain, &mapped, report);

    kiln_mesh_desc mesh = roof(); /* the default material */
    assert_true(complete_mesh(scene, &mesh, &arena, NULL, report));
    assert_int_equal(mesh.primvar_count, 2);

    mesh = roof();
    mesh.material = mapped;
    assert_true(complete_mesh(scene, &mesh, &arena, NULL, report));
    assert_int_equal(mesh.primvar_count, 3);
    assert_true(kiln_scene_add_mesh(scene, &mesh, NULL, report));

    mesh = roof();
    mesh.face_materials = (const kiln_id[]){plain, 0, mapped};
    assert_true(complete_mesh(scene, &mesh, &arena, NULL, report));
    assert_int_equal(mesh.primvar_count, 3);

    /* Tangents that came without normals are dropped; those that came with normals stay. */
    static const float one[] = {0, 0, 1, 1}, up[] = {0, 1, 0};
    const kiln_primvar given[] = {
        uv0,
        {.kind = KILN_PRIMVAR_TANGENT, .interpolation = KILN_CONSTANT, .values = one, .value_count = 1},
        {.kind = KILN_PRIMVAR_NORMAL, .interpolation = KILN_CONSTANT, .values = up, .value_count = 1}};
    mesh = roof();
    mesh.primvars = given;
    mesh.primvar_count = 2;
    assert_true(complete_mesh(scene, &mesh, &arena, NULL, report));
    assert_int_equal(mesh.primvar_count, 2);
    assert_int_equal(last(&mesh)->kind, KILN_PRIMVAR_NORMAL);
    mesh.primvars = given;
    mesh.primvar_count = 3;
    mesh.material = mapped;
    assert_true(complete_mesh(scene, &mesh, &arena, NULL, report));
    assert_ptr_equal(mesh.primvars, given);

    assert_int_equal(kiln_report_size(report), 0);
    kiln_scene_destroy(scene);
    arena_free(&arena);
    kiln_report_destroy(report);
}

static void refuse(kiln_mesh_desc mesh, kiln_code code, const char *what) {
    kiln_arena arena = {0};
    kiln_report *report = kiln_report_create();
    const kiln_where where = where_root("roof.glb");
    assert_false(complete_tangents(&mesh, 0, &arena, &where, report));
    assert_int_equal(kiln_report_message(report, 0).code, code);
    assert_string_equal(kiln_report_message(report, 0).where, "roof.glb");
    assert_string_equal(kiln_report_message(report, 0).what, what);
    arena_free(&arena);
    kiln_report_destroy(report);
}

static void refuses_what_cannot_be(void **state) {
    (void)state;
    kiln_mesh_desc mesh = roof();
    mesh.vertex_count = 11;
    refuse(mesh, KILN_CODE_RANGE, "face 2 refers to vertex 11 of 11");
    mesh = roof();
    mesh.face_sizes = (const uint32_t[]){4, 2, 6};
    refuse(mesh, KILN_CODE_GEOMETRY, "face 1 has 2 corners");
    kiln_primvar short_uv = uv0;
    short_uv.value_count = 5;
    mesh = roof();
    mesh.primvars = &short_uv;
    refuse(mesh, KILN_CODE_RANGE, "face 1 refers to value 5 of an attribute of 5");
    mesh = roof();
    mesh.face_sizes = (const uint32_t[]){UINT32_MAX, UINT32_MAX, 4};
    mesh.face_count = 0;
    kiln_arena arena = {0};
    kiln_report *report = kiln_report_create();
    assert_true(complete_tangents(&mesh, 0, &arena, NULL, report)); /* an empty mesh is fine */
    arena_free(&arena);
    kiln_report_destroy(report);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_normals_of_polygons),
        cmocka_unit_test(smooth_normals_of_polygons),
        cmocka_unit_test(tangents_of_polygons),
        cmocka_unit_test(mesh_gets_what_its_materials_need),
        cmocka_unit_test(refuses_what_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
