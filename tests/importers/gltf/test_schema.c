#include "tests/importers/gltf/support.h"

#include "importers/gltf/schema.h"

static void table_is_sorted(void **state) {
    (void)state;
    for (size_t i = 1; i < schema_row_count; i++)
        if (strcmp(schema_rows[i - 1].key, schema_rows[i].key) >= 0) fail_msg("%s", schema_rows[i].key);
}

/* Each of these is something that the parser behind would take for absent, or cut. */
static void refuses_wrong_types(void **state) {
    (void)state;
    static const struct { const char *rest, *where, *what; kiln_code code; } rows[] = {
        {"'nodes': [{'mesh': '0'}]", "nodes[0].mesh", "an integer is expected, not a string", KILN_CODE_SYNTAX},
        {"'nodes': [{}, {'mesh': -1}]", "nodes[1].mesh", "not -1", KILN_CODE_RANGE},
        {"'nodes': [{'mesh': 0.0}]", "nodes[0].mesh", "not 0.0", KILN_CODE_RANGE},
        {"'nodes': [{'mesh': 4294967296}]", "nodes[0].mesh", "too large", KILN_CODE_RANGE},
        {"'nodes': [{'children': [0, 1e1]}]", "nodes[0].children[1]", "not 1e1", KILN_CODE_RANGE},
        {"'nodes': [{'matrix': [1, 2]}]", "nodes[0].matrix", "2 numbers (16 are expected)", KILN_CODE_RANGE},
        {"'nodes': [{'scale': [1, 'x', 1]}]", "nodes[0].scale[1]", "a number is expected", KILN_CODE_SYNTAX},
        {"'nodes': {}", "nodes", "an array is expected, not an object", KILN_CODE_SYNTAX},
        {"'nodes': [null]", "nodes[0]", "not null", KILN_CODE_SYNTAX},
        {"'meshes': [{}]", "meshes[0]", "primitives is missing", KILN_CODE_SYNTAX},
        {"'meshes': [{'primitives': [{'attributes': {'POSITION': 'a'}}]}]", "meshes[0].primitives[0].attributes.POSITION",
         "index of an accessor", KILN_CODE_SYNTAX},
        {"'meshes': [{'primitives': [{'attributes': {}, 'indices': 3}]}]", "meshes[0].primitives[0].indices",
         "accessor 3 does not exist (the file has 0)", KILN_CODE_REFERENCE},
        {"'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1]}}]",
         "materials[0].pbrMetallicRoughness.baseColorFactor", "3 numbers (4", KILN_CODE_RANGE},
        {"'materials': [{'normalTexture': {}}]", "materials[0].normalTexture", "index is missing", KILN_CODE_SYNTAX},
        {"'materials': [{'doubleSided': 1}]", "materials[0].doubleSided", "true or false", KILN_CODE_SYNTAX},
        {"'materials': [{'extensions': {'KHR_materials_ior': 1.5}}]", "materials[0].extensions.KHR_materials_ior",
         "an object is expected", KILN_CODE_SYNTAX},
        {"'accessors': [{'count': 1, 'type': 'SCALAR'}]", "accessors[0]", "componentType is missing", KILN_CODE_SYNTAX},
        {"'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1}}]", "cameras[0].perspective", "znear is missing",
         KILN_CODE_SYNTAX},
        {"'extensions': {'KHR_lights_punctual': {'lights': [{'type': 'spot'}]}}",
         "extensions.KHR_lights_punctual.lights[0]", "spot is missing", KILN_CODE_SYNTAX},
        {"'extensions': {'KHR_lights_punctual': {'lights': [{}]}}", "extensions.KHR_lights_punctual.lights[0]", "type is missing",
         KILN_CODE_SYNTAX},
        {"'cameras': [{'type': 'orthographic', 'perspective': {'yfov': 1, 'znear': 1}}]", "cameras[0]", "orthographic is missing",
         KILN_CODE_SYNTAX},
        {"'cameras': [{'type': 'fisheye'}]", "cameras[0].type", "\"fisheye\" is no known type", KILN_CODE_RANGE},
        {"'accessors': [{'componentType': 5126, 'count': 1, 'type': 'VEC5'}]", "accessors[0].type", "\"VEC5\"", KILN_CODE_RANGE},
        {"'accessors': [{'componentType': 6, 'count': 1, 'type': 'VEC4'}]", "accessors[0].componentType", "6 is no component type",
         KILN_CODE_RANGE},
        {"'bufferViews': [{'buffer': 0, 'byteLength': 1, 'byteStride': 6}]", "bufferViews[0].byteStride", "6 is no multiple of 4",
         KILN_CODE_RANGE},
        {"'bufferViews': [{'buffer': 0, 'byteLength': 1, 'byteStride': 256}]", "bufferViews[0].byteStride", "256", KILN_CODE_RANGE},
        {"'extensionsUsed': [1]", "extensionsUsed[0]", "a string is expected", KILN_CODE_SYNTAX},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        import_bad(NULL, 0, rows[i].rest, rows[i].code, rows[i].where, rows[i].what);
}

static void lets_the_rest_pass(void **state) {
    (void)state;
    kiln_scene *scene = import_warned(TRIANGLE_DATA,
                                      TRIANGLE ", 'nodes': [{'mesh': 0, 'extras': {'mesh': 'x', 'children': 1}, "
                                      "'unknown': {'mesh': 'x'}, 'extensions': {'X_y': {'mesh': 'x'}}}], 'extras': [null]",
                                      KILN_CODE_IGNORED, "nodes[0].extensions.X_y", "X_y is not known");
    assert_int_equal(scene->instance_count, 1);
    kiln_scene_destroy(scene);
}

static void wants_an_asset(void **state) {
    (void)state;
    import_bad_text("{}", KILN_CODE_SYNTAX, "test.gltf: asset", "asset.version is missing");
    import_bad_text("{\"asset\": {}}", KILN_CODE_SYNTAX, "test.gltf: asset", "version is missing");
    import_bad_text("[]", KILN_CODE_SYNTAX, "test.gltf", "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_is_sorted),
        cmocka_unit_test(refuses_wrong_types),
        cmocka_unit_test(lets_the_rest_pass),
        cmocka_unit_test(wants_an_asset),
    };
    return cmocka_run_group_tests_name("schema", tests, NULL, NULL);
}
