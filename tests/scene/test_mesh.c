#include "tests/scene/support.h"

#include <math.h>

#define REFUSED(desc, where, what)                                                                                     \
    do {                                                                                                               \
        assert_false(kiln_scene_add_mesh(f->scene, &(desc), NULL, f->report));                                         \
        assert_true(says(f->report, KILN_ERROR, where, what));                                                         \
        assert_int_equal(f->scene->mesh_count, 0);                                                                     \
    } while (0)

static void keeps_its_own_copy(void **state) {
    fixture *f = *state;
    float positions[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -2, .5f, 3};
    uint32_t sizes[2] = {4, 3}, corners[7] = {0, 1, 2, 3, 0, 3, 4};
    kiln_mesh_desc desc = {.name = "tent", .vertex_count = 5, .positions = positions, .face_count = 2,
                           .face_sizes = sizes, .face_vertices = corners};
    kiln_id id = 0;
    assert_true(kiln_scene_add_mesh(f->scene, &desc, &id, f->report));
    assert_int_equal(id, 1);
    memset(positions, 0xff, sizeof positions);
    memset(sizes, 0xff, sizeof sizes);
    memset(corners, 0xff, sizeof corners);
    const kiln_mesh *m = scene_mesh(f->scene, id);
    assert_string_equal(m->name, "tent");
    assert_int_equal(m->corner_count, 7);
    assert_int_equal(m->triangle_count, 3);
    assert_int_equal(mesh_face_first(m, 1), 4);
    assert_int_equal(mesh_face_size(m, 1), 3);
    assert_int_equal(m->face_vertices[6], 4);
    assert_true(m->positions[14] == 3 && m->min[0] == -2 && m->max[2] == 3);
    assert_int_equal(kiln_report_size(f->report), 0);
}

static void triangles_need_no_offsets(void **state) {
    fixture *f = *state;
    kiln_mesh_desc desc = triangle_desc();
    uint32_t size = 3;
    desc.face_sizes = &size;
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    assert_null(scene_mesh(f->scene, 1)->face_offsets);
}

static void refuses_positions_that_are_not_finite(void **state) {
    fixture *f = *state;
    float positions[18];
    memcpy(positions, triangle_positions, sizeof triangle_positions);
    memcpy(positions + 9, triangle_positions, sizeof triangle_positions);
    kiln_mesh_desc desc = triangle_desc();
    desc.positions = positions;
    desc.time_count = 2;
    positions[9 + 5] = NAN; /* the second time */
    REFUSED(desc, "mesh 'triangle'", "vertex 1 has a position that is not finite");
    positions[0] = -INFINITY;
    REFUSED(desc, "mesh 'triangle'", "vertex 0 has a position that is not finite");
}

static void refuses_faces_that_are_none(void **state) {
    fixture *f = *state;
    kiln_where file = where_root("car.glb");
    scene_locate(f->scene, &file);
    kiln_mesh_desc desc = triangle_desc();
    const uint32_t far[3] = {0, 1, 3}, two = 2;
    desc.face_vertices = far;
    REFUSED(desc, "car.glb: mesh 'triangle'", "face 0 uses vertex 3 of 3");
    desc = triangle_desc();
    desc.face_sizes = &two;
    REFUSED(desc, "car.glb: mesh 'triangle'", "face 0 has 2 corners");
    desc = triangle_desc();
    desc.face_vertices = NULL;
    REFUSED(desc, "car.glb: mesh 'triangle'", "an array of 3 elements is missing");
    desc = triangle_desc();
    desc.face_count = UINT32_MAX;
    REFUSED(desc, "car.glb: mesh 'triangle'", "12884901885 corners");
    desc = triangle_desc();
    desc.time_count = 130;
    REFUSED(desc, "car.glb: mesh 'triangle'", "130 time samples");
    desc = triangle_desc();
    desc.material = 1;
    REFUSED(desc, "car.glb: mesh 'triangle'", "material 1 does not exist (the scene has 0)");
    const kiln_id materials[1] = {7};
    desc = triangle_desc();
    desc.face_materials = materials;
    REFUSED(desc, "car.glb: mesh 'triangle'", "material 7 does not exist");
}

static void empty_meshes_are_allowed_with_a_warning(void **state) {
    fixture *f = *state;
    assert_true(kiln_scene_add_mesh(f->scene, &(kiln_mesh_desc){0}, NULL, f->report));
    assert_true(says(f->report, KILN_WARNING, "mesh 1", "the mesh has no faces"));
    assert_int_equal(scene_mesh(f->scene, 1)->triangle_count, 0);
}

static void names_cannot_reach_the_terminal(void **state) {
    fixture *f = *state;
    kiln_mesh_desc desc = {.name = "a\x1b[31mb\n"};
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    assert_true(says(f->report, KILN_WARNING, "mesh 'a?[31mb?'", ""));
    char longest[300];
    memset(longest, 'x', sizeof longest);
    memcpy(longest + 78, "é", 2); /* the cut falls inside it */
    longest[299] = 0;
    desc.name = longest;
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    char expected[100] = "mesh '";
    memset(expected + 6, 'x', 78);
    memcpy(expected + 84, "'", 2);
    assert_true(says(f->report, KILN_WARNING, "", "the mesh has no faces"));
    assert_string_equal(scene_mesh(f->scene, 2)->name, longest);
    kiln_report_clear(f->report);
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    assert_true(says(f->report, KILN_WARNING, expected, ""));
}

static void primvars_match_their_interpolation(void **state) {
    fixture *f = *state;
    static const float zeros[16];
    const struct {
        kiln_primvar primvar;
        const char *where, *what;
    } bad[] = {
        {{KILN_PRIMVAR_NORMAL, 0, KILN_VERTEX, zeros, 2, NULL}, "mesh 'triangle': normals", "2 values for 3 vertices"},
        {{KILN_PRIMVAR_UV, 1, KILN_FACE_VARYING, zeros, 4, NULL}, "mesh 'triangle': UV set 1",
         "4 values for 3 corners"},
        {{KILN_PRIMVAR_COLOR, 0, KILN_UNIFORM, zeros, 3, NULL}, "mesh 'triangle': colours", "3 values for 1 faces"},
        {{KILN_PRIMVAR_TANGENT, 0, KILN_CONSTANT, zeros, 0, NULL}, "mesh 'triangle': tangents", "0 values for 1 mesh"},
        {{KILN_PRIMVAR_UV, 0, KILN_VERTEX, zeros, 2, triangle_corners}, "mesh 'triangle': UV set 0",
         "index 2 of 2 values"},
        {{KILN_PRIMVAR_UV, 0, KILN_VERTEX, NULL, 3, NULL}, "mesh 'triangle'", "an array of 3 elements is missing"},
        {{(kiln_primvar_kind)9, 0, KILN_VERTEX, zeros, 3, NULL}, "mesh 'triangle'", "primvar kind 9"},
        {{KILN_PRIMVAR_UV, 0, (kiln_interpolation)9, zeros, 3, NULL}, "mesh 'triangle'", "interpolation 9"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        kiln_mesh_desc desc = triangle_desc();
        desc.primvars = &bad[i].primvar;
        desc.primvar_count = 1;
        REFUSED(desc, bad[i].where, bad[i].what);
    }
}

static void primvars_are_found_by_face_corner_and_vertex(void **state) {
    fixture *f = *state;
    const float values[4] = {10, 11, 20, 21};
    const uint32_t indices[3] = {1, 0, 1};
    const kiln_primvar uv[2] = {{KILN_PRIMVAR_UV, 0, KILN_FACE_VARYING, values, 2, indices},
                                {KILN_PRIMVAR_UV, 3, KILN_CONSTANT, values + 2, 1, NULL}};
    kiln_mesh_desc desc = triangle_desc();
    desc.primvars = uv;
    desc.primvar_count = 2;
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    const kiln_mesh *m = scene_mesh(f->scene, 1);
    assert_null(mesh_primvar(m, KILN_PRIMVAR_UV, 1));
    assert_true(primvar_at(mesh_primvar(m, KILN_PRIMVAR_UV, 0), 0, 2, 2)[0] == 20);
    assert_true(primvar_at(mesh_primvar(m, KILN_PRIMVAR_UV, 0), 0, 1, 2)[1] == 11);
    assert_true(primvar_at(mesh_primvar(m, KILN_PRIMVAR_UV, 3), 0, 1, 2)[0] == 20);
}

static void values_that_are_not_numbers_are_counted(void **state) {
    fixture *f = *state;
    const float normals[9] = {0, 0, 1, NAN, 0, 1, 0, INFINITY, 0};
    const float colors[12] = {1, 1, 1, 1, NAN, 0, 0, 0, -1, .5f, 3, 1};
    const float tangents[12] = {1, 0, 0, -1, 1, 0, 0, 0, 1, 0, 0, -.5f};
    const kiln_primvar primvars[] = {{KILN_PRIMVAR_NORMAL, 0, KILN_VERTEX, normals, 3, NULL},
                                     {KILN_PRIMVAR_COLOR, 0, KILN_VERTEX, colors, 3, NULL},
                                     {KILN_PRIMVAR_TANGENT, 0, KILN_VERTEX, tangents, 3, NULL},
                                     {KILN_PRIMVAR_NORMAL, 0, KILN_VERTEX, normals, 3, NULL}};
    kiln_mesh_desc desc = triangle_desc();
    desc.primvars = primvars;
    desc.primvar_count = 4;
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    const kiln_mesh *m = scene_mesh(f->scene, 1);
    assert_int_equal(m->primvar_count, 3);
    assert_memory_equal(m->primvars[0].values, ((float[9]){0, 0, 1}), 9 * sizeof(float));
    assert_memory_equal(m->primvars[1].values, ((float[12]){1, 1, 1, 1, 1, 1, 1, 1, 0, .5f, 1, 1}), 12 * sizeof(float));
    assert_memory_equal(m->primvars[2].values, ((float[12]){1, 0, 0, -1, 1, 0, 0, 1, 1, 0, 0, -1}), 12 * sizeof(float));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle': normals",
                     "2 of 3 values are not finite: zero is used"));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle': colours",
                     "1 of 3 values are not finite: white is used"));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle': colours",
                     "1 of 3 values lie outside their domain: clamped"));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle': tangents", "2 of 3 values lie outside their domain"));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle'", "primvar 3 repeats an earlier one"));
}

static void subdivision_tags_are_cleaned(void **state) {
    fixture *f = *state;
    const uint32_t creases[10] = {0, 1, 1, 9, 1, 2, 2, 0, 0, 2}, corners[2] = {5, 2}, holes[3] = {0, 77, UINT32_MAX};
    const float crease_sharpness[5] = {INFINITY, 2, NAN, -2, 3.5f}, corner_sharpness[2] = {1, 1e9f};
    kiln_mesh_desc desc = triangle_desc();
    desc.subdivision = (kiln_subdivision){.scheme = KILN_SCHEME_LOOP, .crease_vertices = creases,
                                          .crease_sharpness = crease_sharpness, .crease_count = 5,
                                          .corner_vertices = corners, .corner_sharpness = corner_sharpness,
                                          .corner_count = 2, .holes = holes, .hole_count = 3};
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    const kiln_subdivision *s = &scene_mesh(f->scene, 1)->subdivision;
    assert_int_equal(s->crease_count, 2);
    assert_memory_equal(s->crease_vertices, ((uint32_t[4]){0, 1, 0, 2}), sizeof(uint32_t[4]));
    assert_true(s->crease_sharpness[0] == 10 && s->crease_sharpness[1] == 3.5f);
    assert_true(s->corner_count == 1 && s->corner_vertices[0] == 2 && s->corner_sharpness[0] == 10);
    assert_true(s->hole_count == 1 && s->holes[0] == 0);
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle'", "2 creases name"));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle'", "1 corners name"));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle'", "2 holes name"));
}

static void a_replaced_mesh_keeps_its_handle(void **state) {
    fixture *f = *state;
    kiln_mesh_desc desc = triangle_desc();
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    kiln_arena arena = {0};
    float *positions = arena_copy(&arena, triangle_positions, 3, 3 * sizeof(float));
    positions[0] = -5;
    desc.positions = positions;
    desc.face_vertices = arena_copy(&arena, triangle_corners, 3, sizeof(uint32_t));
    assert_true(scene_replace_mesh(f->scene, 1, &arena, &desc, f->report));
    assert_null(arena.blocks);
    assert_ptr_equal(scene_mesh(f->scene, 1)->positions, positions);
    assert_true(scene_mesh(f->scene, 1)->min[0] == -5);

    positions = arena_copy(&arena, triangle_positions, 3, 3 * sizeof(float));
    positions[0] = NAN;
    desc.positions = positions;
    desc.face_vertices = arena_copy(&arena, triangle_corners, 3, sizeof(uint32_t));
    assert_false(scene_replace_mesh(f->scene, 1, &arena, &desc, f->report));
    assert_null(arena.blocks);
    assert_true(scene_mesh(f->scene, 1)->min[0] == -5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCENE_TEST(keeps_its_own_copy),
        SCENE_TEST(triangles_need_no_offsets),
        SCENE_TEST(refuses_positions_that_are_not_finite),
        SCENE_TEST(refuses_faces_that_are_none),
        SCENE_TEST(empty_meshes_are_allowed_with_a_warning),
        SCENE_TEST(names_cannot_reach_the_terminal),
        SCENE_TEST(primvars_match_their_interpolation),
        SCENE_TEST(primvars_are_found_by_face_corner_and_vertex),
        SCENE_TEST(values_that_are_not_numbers_are_counted),
        SCENE_TEST(subdivision_tags_are_cleaned),
        SCENE_TEST(a_replaced_mesh_keeps_its_handle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
