#include "tests/scene/support.h"

#include <math.h>

static void add_triangle(fixture *f) {
    kiln_mesh_desc desc = triangle_desc();
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
}

static void add_instance(fixture *f, kiln_id mesh, mat4 transform) {
    kiln_instance_desc desc = {.mesh = mesh, .time_count = 1, .transforms = transform.m};
    assert_true(kiln_scene_add_instance(f->scene, &desc, NULL, f->report));
}

static mat4 moved(double x, double y, double z) {
    mat4 m = mat4_identity();
    m.m[12] = x, m.m[13] = y, m.m[14] = z;
    return m;
}

static void assert_bounds(fixture *f, const double min[3], const double max[3]) {
    kiln_bounds b = kiln_scene_bounds(f->scene);
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(b.min[k] - min[k]) <= 1e-12 * (1 + fabs(min[k])));
        assert_true(fabs(b.max[k] - max[k]) <= 1e-12 * (1 + fabs(max[k])));
    }
}

static void counts_meshes_and_instances(void **state) {
    fixture *f = *state;
    add_triangle(f);
    add_triangle(f);
    for (int i = 0; i < 3; i++) add_instance(f, 2, moved(i, 0, 0));
    kiln_scene_counts c = kiln_scene_count(f->scene);
    assert_int_equal(c.meshes, 2);
    assert_int_equal(c.instances, 3);
    assert_int_equal(c.triangles, 3);
    assert_int_equal(c.triangles_unique, 2);
    assert_false(c.has_environment);
}

static void many_objects_keep_their_handles(void **state) {
    fixture *f = *state;
    add_triangle(f);
    for (uint32_t i = 1; i <= 1000; i++) {
        char name[16];
        snprintf(name, sizeof name, "i%u", i);
        kiln_id id;
        assert_true(kiln_scene_add_instance(f->scene, &(kiln_instance_desc){.name = name, .mesh = 1}, &id, f->report));
        assert_int_equal(id, i);
    }
    assert_string_equal(scene_instance(f->scene, 777)->name, "i777");
    assert_true(scene_instance(f->scene, 777)->transforms[0].m[15] == 1);
}

static void bounds_are_tight_and_double(void **state) {
    fixture *f = *state;
    add_triangle(f);
    add_instance(f, 1, moved(1e9, 0.25, 0)); /* a float would lose the quarter */
    add_instance(f, 1, moved(1e9 + 2, 0.5, -3));
    assert_true(kiln_scene_commit(f->scene, f->report));
    assert_bounds(f, (double[3]){1e9, 0.25, -3}, (double[3]){1e9 + 3, 1.5, 0});
}

/* The triangle's box, turned by 45°, sticks out further than the triangle: (0,0), (1,0), (0,1) become (0,0),
 * (√½, √½), (−√½, √½), but the box's corner (1,1) would reach y = √2. */
static void bounds_follow_vertices_not_boxes(void **state) {
    fixture *f = *state;
    add_triangle(f);
    double h = sqrt(.5);
    mat4 turn = mat4_identity();
    turn.m[0] = h, turn.m[1] = h, turn.m[4] = -h, turn.m[5] = h;
    add_instance(f, 1, turn);
    for (int i = 0; i < 100; i++) add_instance(f, 1, (mat4){{.01, 0, 0, 0, 0, .01, 0, 0, 0, 0, .01, 0, 0, .1, 0, 1}});
    /* inside the box of the first one, but higher than its vertices */
    add_instance(f, 1, (mat4){{.01, 0, 0, 0, 0, .01, 0, 0, 0, 0, .01, 0, 0, 1.2, 0, 1}});
    assert_true(kiln_scene_commit(f->scene, f->report));
    assert_bounds(f, (double[3]){-h, 0, 0}, (double[3]){h, 1.21, 0});
}

static void bounds_hold_every_time(void **state) {
    fixture *f = *state;
    float positions[18];
    memcpy(positions, triangle_positions, sizeof triangle_positions);
    for (int i = 0; i < 9; i++) positions[9 + i] = 2 * triangle_positions[i];
    kiln_mesh_desc desc = triangle_desc();
    desc.positions = positions;
    desc.time_count = 2;
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    mat4 times[2] = {moved(0, 0, 0), moved(0, 0, 7)};
    kiln_instance_desc instance = {.mesh = 1, .time_count = 2, .transforms = times[0].m};
    assert_true(kiln_scene_add_instance(f->scene, &instance, NULL, f->report));
    assert_true(kiln_scene_commit(f->scene, f->report));
    assert_bounds(f, (double[3]){0, 0, 0}, (double[3]){2, 2, 7});
}

static void an_empty_scene_has_empty_bounds(void **state) {
    fixture *f = *state;
    assert_true(kiln_scene_add_mesh(f->scene, &(kiln_mesh_desc){0}, NULL, f->report));
    add_instance(f, 1, moved(5, 5, 5));
    assert_true(kiln_scene_commit(f->scene, f->report));
    kiln_bounds b = kiln_scene_bounds(f->scene);
    assert_true(b.min[0] > b.max[0]);
}

static void instances_are_checked(void **state) {
    fixture *f = *state;
    add_triangle(f);
    mat4 m = mat4_identity();
    kiln_instance_desc desc = {.name = "wheel", .mesh = 2, .time_count = 1, .transforms = m.m};
    assert_false(kiln_scene_add_instance(f->scene, &desc, NULL, f->report));
    assert_true(says(f->report, KILN_ERROR, "instance 'wheel'", "mesh 2 does not exist (the scene has 1)"));
    desc.mesh = 0;
    assert_false(kiln_scene_add_instance(f->scene, &desc, NULL, f->report));
    desc.mesh = 1;
    m.m[5] = NAN;
    assert_false(kiln_scene_add_instance(f->scene, &desc, NULL, f->report));
    assert_true(says(f->report, KILN_ERROR, "instance 'wheel'", "element 5 of the transform is not a finite number"));
    m.m[5] = 0;
    m.m[3] = .5;
    kiln_report_clear(f->report);
    assert_true(kiln_scene_add_instance(f->scene, &desc, NULL, f->report));
    assert_true(says(f->report, KILN_WARNING, "instance 'wheel'", "the transform is singular"));
    assert_true(says(f->report, KILN_WARNING, "instance 'wheel'", "the transform is not affine"));
    assert_true(scene_instance(f->scene, 1)->flat && scene_instance(f->scene, 1)->transforms[0].m[3] == 0);
    assert_int_equal(f->scene->instance_count, 1);
}

static void worlds_beyond_double_are_refused(void **state) {
    fixture *f = *state;
    float far = 1e38f;
    const float positions[9] = {far, 0, 0, 1, 0, 0, 0, far, 0};
    kiln_mesh_desc desc = triangle_desc();
    desc.positions = positions;
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    mat4 m = mat4_identity();
    m.m[0] = m.m[5] = m.m[10] = 1e300;
    add_instance(f, 1, m);
    assert_false(kiln_scene_commit(f->scene, f->report));
    assert_true(says(f->report, KILN_ERROR, "instance 1", "its world positions are not finite numbers"));
}

static void nothing_enters_after_the_commit(void **state) {
    fixture *f = *state;
    add_triangle(f);
    assert_true(kiln_scene_commit(f->scene, f->report));
    kiln_mesh_desc mesh = triangle_desc();
    kiln_material material = kiln_material_default();
    kiln_light light = kiln_light_default();
    kiln_camera camera = kiln_camera_default();
    const uint8_t pixel = 0;
    assert_false(kiln_scene_add_mesh(f->scene, &mesh, NULL, f->report));
    assert_false(kiln_scene_add_material(f->scene, &material, NULL, f->report));
    assert_false(kiln_scene_add_light(f->scene, &light, NULL, f->report));
    assert_false(kiln_scene_add_camera(f->scene, &camera, NULL, f->report));
    assert_false(kiln_scene_add_instance(f->scene, &(kiln_instance_desc){.mesh = 1}, NULL, f->report));
    assert_false(kiln_scene_add_image(
        f->scene, &(kiln_image_desc){.pixels = &pixel, .width = 1, .height = 1, .channels = 1}, NULL, f->report));
    assert_false(kiln_scene_set_environment(f->scene, &(kiln_environment){0}, f->report));
    assert_false(kiln_scene_commit(f->scene, f->report));
    assert_int_equal(kiln_report_count(f->report, KILN_ERROR), 8);
    assert_int_equal(f->scene->mesh_count + f->scene->material_count + f->scene->instance_count, 1);
}

static void missing_uv_sets_are_told_once(void **state) {
    fixture *f = *state;
    const uint8_t pixel = 0;
    assert_true(kiln_scene_add_image(
        f->scene, &(kiln_image_desc){.pixels = &pixel, .width = 1, .height = 1, .channels = 1}, NULL, f->report));
    kiln_material material = kiln_material_default();
    material.name = "paint";
    material.base_color.texture = (kiln_texture){.image = 1, .uv_set = 2};
    material.roughness.texture = (kiln_texture){.image = 1, .uv_set = 2};
    material.transmission.texture = (kiln_texture){.image = 1, .uv_set = 5}; /* a layer that is absent */
    assert_true(kiln_scene_add_material(f->scene, &material, NULL, f->report));
    kiln_mesh_desc mesh = triangle_desc();
    mesh.material = 1;
    assert_true(kiln_scene_add_mesh(f->scene, &mesh, NULL, f->report));
    assert_true(kiln_scene_commit(f->scene, f->report));
    assert_true(says(f->report, KILN_WARNING, "mesh 'triangle'",
                     "UV set 2, which a texture of material 'paint' reads"));
    assert_int_equal(kiln_report_count(f->report, KILN_WARNING), 1);
}

static void what_has_no_name_has_its_handle(void **state) {
    (void)state;
    kiln_arena arena = {0};
    const char *name = "lamp";
    assert_ptr_equal(scene_name(&arena, name, "light_", 3), name);
    assert_string_equal(scene_name(&arena, "", "light_", 3), "light_3");
    assert_string_equal(scene_name(&arena, NULL, "object ", 4294967295u), "object 4294967295");
    arena_free(&arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCENE_TEST(counts_meshes_and_instances),
        SCENE_TEST(many_objects_keep_their_handles),
        SCENE_TEST(bounds_are_tight_and_double),
        SCENE_TEST(bounds_follow_vertices_not_boxes),
        SCENE_TEST(bounds_hold_every_time),
        SCENE_TEST(an_empty_scene_has_empty_bounds),
        SCENE_TEST(instances_are_checked),
        SCENE_TEST(worlds_beyond_double_are_refused),
        SCENE_TEST(nothing_enters_after_the_commit),
        SCENE_TEST(missing_uv_sets_are_told_once),
        cmocka_unit_test(what_has_no_name_has_its_handle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
