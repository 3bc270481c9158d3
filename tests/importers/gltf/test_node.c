#include "tests/importers/gltf/support.h"

#include "base/mat.h"

static kiln_scene *scene;

static int tear_down(void **state) {
    (void)state;
    kiln_scene_destroy(scene);
    scene = NULL;
    return 0;
}

static void import_nodes(const char *nodes) {
    kiln_text rest = {0};
    text_format(&rest, TRIANGLE ", %s", nodes);
    scene = import_good(TRIANGLE_DATA, rest.data);
    text_free(&rest);
}

static void refused(const char *nodes, kiln_code code, const char *where, const char *what) {
    kiln_text rest = {0};
    text_format(&rest, TRIANGLE ", %s", nodes);
    import_bad(TRIANGLE_DATA, rest.data, code, where, what);
    text_free(&rest);
}

static void assert_point(const double *transform, dvec3 from, dvec3 to) {
    mat4 m = mat4_load(transform);
    dvec3 p = mat4_point(&m, from);
    if (d3_length(d3_sub(p, to)) > 1e-12 * (1 + d3_length(to))) fail_msg("%g %g %g, expected %g %g %g", p.x, p.y, p.z, to.x, to.y, to.z);
}

static void composes_transforms(void **state) {
    (void)state;
    /* A quarter turn about z, of length 2 in the file. */
    import_nodes("'nodes': [{'translation': [10, 0, 0], 'rotation': [0, 0, 1.4142135623730951, 1.4142135623730951], "
                 "'scale': [2, 3, 4], 'children': [1]}, {'name': 'leaf', 'mesh': 0, 'matrix': [1,0,0,0, 0,-1,0,0, 0,0,1,0, 1,2,3,1]}]");
    assert_int_equal(scene->instance_count, 1);
    assert_string_equal(scene_instance(scene, 1)->name, "leaf");
    /* (1, 1, 1) → (2, 1, 4) → scaled (4, 3, 16) → turned (−3, 4, 16) → (7, 4, 16) */
    assert_point(scene_instance(scene, 1)->transforms[0].m, (dvec3){1, 1, 1}, (dvec3){7, 4, 16});
    mat4 m = scene_instance(scene, 1)->transforms[0];
    assert_true(mat4_determinant(&m) < 0);
}

static void survives_odd_rotations(void **state) {
    (void)state;
    import_nodes("'nodes': [{'mesh': 0, 'rotation': [0, 0, 0, 0]}]");
    assert_point(scene_instance(scene, 1)->transforms[0].m, (dvec3){1, 2, 3}, (dvec3){1, 2, 3});
}

static void keeps_double_precision(void **state) {
    (void)state;
    import_nodes("'nodes': [{'translation': [1e9, 0, 0], 'children': [1]}, {'mesh': 0, 'translation': [0.001, 0, 0]}]");
    assert_true(scene_instance(scene, 1)->transforms[0].m[12] == 1e9 + 0.001);
}

static void shares_meshes(void **state) {
    (void)state;
    import_nodes("'nodes': [{'mesh': 0}, {'mesh': 0, 'name': 'b'}, {'mesh': 0}]");
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->instance_count, 3);
    assert_string_equal(scene_instance(scene, 1)->name, "m"); /* a nameless node's is the mesh's */
    assert_string_equal(scene_instance(scene, 2)->name, "b");
}

static void chooses_the_scene(void **state) {
    (void)state;
    static const char nodes[] = "'nodes': [{'name': 'a', 'mesh': 0}, {'name': 'b', 'mesh': 0, 'children': [2]}, {'name': 'c', 'mesh': 0}]";
    static const struct { const char *scenes; const char *names; } rows[] = {
        {", 'scene': 1, 'scenes': [{'nodes': [0]}, {'nodes': [1]}]", "bc"},
        {", 'scenes': [{'nodes': [0]}, {'nodes': [1]}]", "a"}, /* the first, without a default */
        {", 'scenes': [{'nodes': [1, 0]}]", "bca"},            /* in the order of the hierarchy */
        {"", "abc"},                                           /* all roots, without any scene */
        {", 'scenes': [{}]", ""}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_text rest = {0};
        text_format(&rest, TRIANGLE ", %s%s", nodes, rows[i].scenes);
        char *json = document(TRIANGLE_DATA, rest.data);
        kiln_report *report = kiln_report_create();
        kiln_scene *s = import_text(json, report);
        assert_non_null(s);
        assert_int_equal(s->instance_count, strlen(rows[i].names));
        for (uint32_t k = 0; k < s->instance_count; k++) assert_int_equal(scene_instance(s, k + 1)->name[0], rows[i].names[k]);
        if (!*rows[i].names) assert_message(report, KILN_WARNING, KILN_CODE_GEOMETRY, "test.gltf", "no surfaces");
        kiln_scene_destroy(s);
        kiln_report_destroy(report);
        text_free(&rest);
        free(json);
    }
}

static void refuses_broken_hierarchies(void **state) {
    (void)state;
    refused("'nodes': [{'children': [0]}]", KILN_CODE_REFERENCE, "nodes[0]", "own ancestor");
    refused("'nodes': [{}, {'children': [2]}, {'children': [3]}, {'children': [1]}]", KILN_CODE_REFERENCE, "nodes[1]", "own ancestor");
    refused("'nodes': [{'children': [2]}, {'children': [2]}, {}]", KILN_CODE_REFERENCE, "nodes[1].children[0]",
            "node 2 is a child of node 0 already");
    refused("'nodes': [{'children': [1, 1]}, {}]", KILN_CODE_REFERENCE, "nodes[0].children[1]", "already");
    refused("'nodes': [{'children': [5]}]", KILN_CODE_REFERENCE, "nodes[0].children[0]", "node 5 does not exist (the file has 1)");
    refused("'nodes': [{'children': [1]}, {}], 'scenes': [{'nodes': [1]}]", KILN_CODE_REFERENCE, "scenes[0].nodes[0]", "cannot be a root");
    refused("'nodes': [{}], 'scenes': [{'nodes': [0, 0]}]", KILN_CODE_REFERENCE, "scenes[0].nodes[1]", "there twice");
    refused("'nodes': [{}], 'scenes': [{'nodes': [3]}]", KILN_CODE_REFERENCE, "scenes[0].nodes[0]", "node 3");
    refused("'nodes': [{}], 'scenes': [{}], 'scene': 1", KILN_CODE_REFERENCE, "scene", "scene 1 does not exist (the file has 1)");
    refused("'nodes': [{'mesh': 1}]", KILN_CODE_REFERENCE, "nodes[0].mesh", "mesh 1 does not exist (the file has 1)");
    refused("'nodes': [{'camera': 0}]", KILN_CODE_REFERENCE, "nodes[0].camera", "camera 0");
    refused("'nodes': [{'skin': 2}]", KILN_CODE_REFERENCE, "nodes[0].skin", "skin 2");
    refused("'nodes': [{'mesh': 0, 'scale': [1e308, 1, 1], 'children': [1]}, {'mesh': 0, 'scale': [1e308, 1, 1]}]",
            KILN_CODE_RANGE, "nodes[1]", "not a finite number");
}

/* A chain of 100,000 nodes, the last one with the mesh: neither the walk nor the check for loops may recurse. */
static void walks_deep_hierarchies(void **state) {
    (void)state;
    enum { DEPTH = 100000 };
    kiln_text nodes = {0};
    text_append(&nodes, TRIANGLE ", 'nodes': [");
    for (int i = 0; i < DEPTH; i++) text_format(&nodes, "{'translation': [0, 0, 1], 'children': [%d]}, ", i + 1);
    text_append(&nodes, "{'mesh': 0}], 'scenes': [{'nodes': [0]}]");
    char *json = document(TRIANGLE_DATA, nodes.data);
    kiln_report *report = kiln_report_create();
    kiln_scene *s = kiln_scene_create();
    assert_true(gltf_import_memory("deep", json, strlen(json), NULL, NULL, s, report));
    assert_int_equal(s->instance_count, 1);
    assert_true(scene_instance(s, 1)->transforms[0].m[14] == DEPTH);
    kiln_scene_destroy(s);
    kiln_report_destroy(report);
    text_free(&nodes);
    free(json);
}

static void reads_cameras(void **state) {
    (void)state;
    import_nodes("'cameras': [{'type': 'perspective', 'name': 'wide', 'perspective': {'yfov': 1.2, 'znear': 0.1, 'zfar': 50, 'aspectRatio': 1.5}}, "
                 "{'type': 'perspective', 'perspective': {'yfov': 0.5, 'znear': 0.01}}, "
                 "{'type': 'orthographic', 'orthographic': {'xmag': 3, 'ymag': 2, 'znear': 0, 'zfar': 10}}], "
                 "'nodes': [{'camera': 0, 'translation': [1, 2, 3]}, {'camera': 1, 'name': 'n'}, {'camera': 2, 'mesh': 0}]");
    assert_int_equal(scene->camera_count, 3);
    const kiln_camera *c = kiln_scene_camera(scene, 1);
    assert_string_equal(c->name, "wide");
    assert_int_equal(c->projection, KILN_PERSPECTIVE);
    assert_true(c->yfov_rad == 1.2 && c->znear == 0.1 && c->zfar == 50 && c->aspect == 1.5 && c->transform[13] == 2);
    c = kiln_scene_camera(scene, 2);
    assert_string_equal(c->name, "n");
    assert_true(c->aspect == 0 && c->zfar == 0); /* the picture's, infinity */
    c = kiln_scene_camera(scene, 3);
    assert_int_equal(c->projection, KILN_ORTHOGRAPHIC);
    assert_true(c->xmag == 3 && c->ymag == 2 && c->aspect == 1.5);
    refused("'cameras': [{'type': 'perspective', 'perspective': {'yfov': 0, 'znear': 0.1}}], 'nodes': [{'camera': 0}]",
            KILN_CODE_RANGE, "cameras[0]", "yfov_rad is 0");
    refused("'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 2, 'zfar': 1}}], 'nodes': [{'camera': 0}]",
            KILN_CODE_RANGE, "cameras[0]", "zfar");
    refused("'cameras': [{'type': 'orthographic', 'orthographic': {'xmag': 0, 'ymag': 1, 'znear': 0, 'zfar': 1}}], 'nodes': [{'camera': 0}]",
            KILN_CODE_RANGE, "cameras[0]", "xmag");
}

static void ignores_the_scale_of_cameras(void **state) {
    (void)state;
    import_nodes("'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 0.1}}], 'nodes': [{'mesh': 0}, "
                 "{'scale': [2, 2, 2], 'children': [2]}, {'camera': 0, 'translation': [1, 2, 3], 'scale': [3, -1, 0.5], "
                 "'rotation': [0, 0.7071067811865476, 0, 0.7071067811865476]}]");
    const double *m = kiln_scene_camera(scene, 1)->transform;
    assert_point(m, (dvec3){0, 0, 0}, (dvec3){2, 4, 6});
    assert_point(m, (dvec3){0, 0, -1}, (dvec3){1, 4, 6}); /* a quarter turn about y looks along −x */
    assert_point(m, (dvec3){0, 1, 0}, (dvec3){2, 5, 6});
    assert_point(m, (dvec3){1, 0, 0}, (dvec3){2, 4, 5});
    refused("'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 0.1}}], 'nodes': [{'camera': 0, 'scale': [0, 0, 0]}]",
            KILN_CODE_RANGE, "cameras[0]", "flattens");
}

#define LIGHTS(list) "'extensions': {'KHR_lights_punctual': {'lights': [" list "]}}, "
#define LIT(index) "{'extensions': {'KHR_lights_punctual': {'light': " #index "}}, 'name': 'n'}"

static void reads_lights(void **state) {
    (void)state;
    import_nodes(LIGHTS("{'type': 'point', 'name': 'bulb', 'color': [1, 0.5, 0.25], 'intensity': 20}, "
                        "{'type': 'spot', 'spot': {'innerConeAngle': 0.2, 'outerConeAngle': 0.6}}, {'type': 'spot', 'spot': {}}, "
                        "{'type': 'directional', 'intensity': 3}")
                 "'nodes': [" LIT(0) ", " LIT(1) ", " LIT(2) ", " LIT(3) ", {'mesh': 0}]");
    assert_int_equal(scene->light_count, 4);
    const kiln_light *l = scene_light(scene, 1);
    assert_string_equal(l->name, "bulb");
    assert_int_equal(l->kind, KILN_LIGHT_POINT);
    assert_floats(l->color, (float[]){1, 0.5f, 0.25f}, 3);
    assert_floats(&l->intensity, (float[]){20}, 1);
    l = scene_light(scene, 2);
    assert_string_equal(l->name, "n");
    assert_int_equal(l->kind, KILN_LIGHT_SPOT);
    assert_floats((float[]){l->inner_cone_rad, l->outer_cone_rad, l->intensity}, (float[]){0.2f, 0.6f, 1}, 3);
    l = scene_light(scene, 3);
    assert_floats((float[]){l->inner_cone_rad, l->outer_cone_rad}, (float[]){0, 0.785398163f}, 2);
    assert_int_equal(scene_light(scene, 4)->kind, KILN_LIGHT_DISTANT);
    refused(LIGHTS("{'type': 'point'}") "'nodes': [" LIT(1) "]", KILN_CODE_REFERENCE, "nodes[0].extensions.KHR_lights_punctual.light",
            "light 1 does not exist (the file has 1)");
    refused(LIGHTS("{'type': 'laser'}") "'nodes': [" LIT(0) "]", KILN_CODE_RANGE, "KHR_lights_punctual.lights[0].type", "\"laser\"");
    refused(LIGHTS("{'type': 'point', 'color': [1]}") "'nodes': [" LIT(0) "]", KILN_CODE_RANGE, "lights[0].color", "1 numbers");
    refused(LIGHTS("{'type': 'point'}") "'nodes': [" LIT('a') "]", KILN_CODE_SYNTAX, "KHR_lights_punctual.light", "a number is expected");
}

static void mends_cone_angles(void **state) {
    (void)state;
    static const struct { const char *spot; float inner, outer; } rows[] = {
        {"'innerConeAngle': 0.9, 'outerConeAngle': 0.5", 0.5f, 0.5f}, {"'outerConeAngle': 3", 0, 1.57079633f},
        {"'innerConeAngle': -1, 'outerConeAngle': 1", 0, 1}, {"'outerConeAngle': -1", 0, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char rest[800];
        snprintf(rest, sizeof rest, TRIANGLE ", " LIGHTS("{'type': 'spot', 'spot': {%s}}") "'nodes': [" LIT(0) ", {'mesh': 0}]", rows[i].spot);
        kiln_scene *s = import_warned(TRIANGLE_DATA, rest, KILN_CODE_RANGE, "KHR_lights_punctual.lights[0]", "cone angles");
        assert_floats((float[]){scene_light(s, 1)->inner_cone_rad, scene_light(s, 1)->outer_cone_rad},
                      (float[]){rows[i].inner, rows[i].outer}, 2);
        kiln_scene_destroy(s);
    }
}

/* Hidden nodes hide what hangs from them, but not the cameras. */
static void hides_nodes(void **state) {
    (void)state;
    import_nodes(LIGHTS("{'type': 'point'}") "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 0.1}}], "
                 "'nodes': [{'children': [1, 2], 'extensions': {'KHR_node_visibility': {'visible': false}}}, "
                 "{'mesh': 0, 'camera': 0, 'extensions': {'KHR_node_visibility': {'visible': true}}}, " LIT(0) ", "
                 "{'mesh': 0, 'name': 'seen', 'extensions': {'KHR_node_visibility': {}}}]");
    assert_int_equal(scene->instance_count, 1);
    assert_string_equal(scene_instance(scene, 1)->name, "seen");
    assert_int_equal(scene->light_count, 0);
    assert_int_equal(scene->camera_count, 1);
}

#define INSTANCED(attributes) "{'mesh': 0, 'translation': [100, 0, 0], 'scale': [2, 2, 2], 'extensions': {'EXT_mesh_gpu_instancing': {'attributes': {" attributes "}}}}"

static void places_instances(void **state) {
    (void)state;
    import_nodes("'nodes': [" INSTANCED("'TRANSLATION': 0") "]"); /* the triangle's positions serve as offsets */
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->instance_count, 3);
    assert_point(scene_instance(scene, 1)->transforms[0].m, (dvec3){1, 2, 3}, (dvec3){102, 4, 6});
    assert_point(scene_instance(scene, 2)->transforms[0].m, (dvec3){1, 2, 3}, (dvec3){104, 4, 6});
    assert_point(scene_instance(scene, 3)->transforms[0].m, (dvec3){1, 2, 3}, (dvec3){102, 6, 6});
}

static void checks_instances(void **state) {
    (void)state;
    refused("'nodes': [" INSTANCED("'TRANSLATION': 5") "]", KILN_CODE_REFERENCE, "EXT_mesh_gpu_instancing.attributes.TRANSLATION",
            "accessor 5");
    refused("'nodes': [" INSTANCED("'ROTATION': 0") "]", KILN_CODE_RANGE, "attributes.ROTATION", "vectors of 4");
    refused("'nodes': [" INSTANCED("'SCALE': 'x'") "]", KILN_CODE_SYNTAX, "attributes.SCALE", "a number");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(composes_transforms, tear_down),
        cmocka_unit_test_teardown(survives_odd_rotations, tear_down),
        cmocka_unit_test_teardown(keeps_double_precision, tear_down),
        cmocka_unit_test_teardown(shares_meshes, tear_down),
        cmocka_unit_test(chooses_the_scene),
        cmocka_unit_test(refuses_broken_hierarchies),
        cmocka_unit_test(walks_deep_hierarchies),
        cmocka_unit_test_teardown(reads_cameras, tear_down),
        cmocka_unit_test_teardown(ignores_the_scale_of_cameras, tear_down),
        cmocka_unit_test_teardown(reads_lights, tear_down),
        cmocka_unit_test(mends_cone_angles),
        cmocka_unit_test_teardown(hides_nodes, tear_down),
        cmocka_unit_test_teardown(places_instances, tear_down),
        cmocka_unit_test(checks_instances),
    };
    return cmocka_run_group_tests_name("node", tests, NULL, NULL);
}
