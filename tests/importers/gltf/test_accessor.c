#include "tests/importers/gltf/support.h"

/* Accessors are seen through what they become: positions, UVs, colours and faces of a mesh. */

typedef struct mesh_json {
    kiln_text views, accessors;
    unsigned char data[1024];
    size_t size;
    int count;
} mesh_json;

static size_t put(mesh_json *m, const void *data, size_t size) {
    size_t offset = (m->size + 3) / 4 * 4;
    memcpy(m->data + offset, data, size);
    m->size = offset + size;
    return offset;
}

/* A buffer view of its own for each. */
static void add(mesh_json *m, const void *data, size_t size, int stride, int component, int count, const char *type,
                const char *more) {
    size_t offset = put(m, data, size);
    text_format(&m->views, "%s{'buffer': 0, 'byteOffset': %zu, 'byteLength': %zu", m->count ? ", " : "", offset, size);
    if (stride) text_format(&m->views, ", 'byteStride': %d", stride);
    text_append(&m->views, "}");
    text_format(&m->accessors, "%s{'bufferView': %d, 'componentType': %d, 'count': %d, 'type': '%s'%s}", m->count ? ", " : "",
                m->count, component, count, type, more);
    m->count++;
}

static char *finish(mesh_json *m, const char *attributes) {
    kiln_text rest = {0};
    text_format(&rest,
                "'bufferViews': [%s], 'accessors': [%s], 'materials': [{'pbrMetallicRoughness': {}}], "
                "'meshes': [{'primitives': [{%s, 'material': 0}]}], 'nodes': [{'mesh': 0}]",
                m->views.data, m->accessors.data, attributes);
    text_free(&m->views);
    text_free(&m->accessors);
    return text_take(&rest);
}

static kiln_scene *good(mesh_json *m, const char *attributes) {
    char *rest = finish(m, attributes);
    kiln_scene *scene = import_good(m->data, m->size, rest);
    free(rest);
    return scene;
}

static void bad(mesh_json *m, const char *attributes, kiln_code code, const char *where, const char *what) {
    char *rest = finish(m, attributes);
    import_bad(m->data, m->size, rest, code, where, what);
    free(rest);
}

static void add_triangle(mesh_json *m) { add(m, triangle_positions, 36, 0, 5126, 3, "VEC3", ""); }

#define POSITION "'attributes': {'POSITION': 0}"

/* Every component type, normalised as section 3.11 says: f = c / max, signed ones clamped at −1. */
static void reads_component_types(void **state) {
    (void)state;
    static const int8_t i8[6] = {-128, -127, 0, 1, 64, 127};
    static const uint8_t u8[6] = {0, 1, 128, 200, 254, 255};
    static const int16_t i16[6] = {-32768, -32767, 0, 1, 16384, 32767};
    static const uint16_t u16[6] = {0, 1, 32768, 50000, 65534, 65535};
    static const uint32_t u32[6] = {0, 1, 1u << 31, 3000000000u, UINT32_MAX - 255, UINT32_MAX};
    static const float f32[6] = {-1.5f, 0, 1e-30f, 1e30f, 0.1f, 7};
    const struct { int type; const void *data; size_t bytes; double max; } rows[] = {
        {5120, i8, 1, 127}, {5121, u8, 1, 255}, {5122, i16, 2, 32767}, {5123, u16, 2, 65535}, {5125, u32, 4, UINT32_MAX}, {5126, f32, 4, 1}};
    for (size_t row = 0; row < 6; row++)
        for (int normalized = 0; normalized < 2; normalized++) {
            if (rows[row].type == 5126 && normalized) continue;
            mesh_json m = {0};
            add_triangle(&m);
            add(&m, rows[row].data, 6 * rows[row].bytes, 0, rows[row].type, 3, "VEC2", normalized ? ", 'normalized': true" : "");
            kiln_scene *scene = good(&m, "'attributes': {'POSITION': 0, 'TEXCOORD_0': 1}");
            const kiln_primvar *uv = mesh_primvar(scene_mesh(scene, 1), KILN_PRIMVAR_UV, 0);
            float expected[6];
            for (int i = 0; i < 6; i++) {
                double v = row == 0 ? i8[i] : row == 1 ? u8[i] : row == 2 ? i16[i] : row == 3 ? u16[i] : row == 4 ? u32[i] : (double)f32[i];
                v = normalized ? v / rows[row].max : v;
                expected[i] = (float)(normalized && v < -1 ? -1 : v);
            }
            assert_floats(uv->values, expected, 6);
            kiln_scene_destroy(scene);
        }
}

static void reads_strides_and_offsets(void **state) {
    (void)state;
    float interleaved[3][5] = {{0, 0, 0, 0.25f, 0.5f}, {1, 0, 0, 0.75f, 1}, {0, 1, 0, 2, 3}};
    mesh_json m = {0};
    size_t offset = put(&m, interleaved, sizeof interleaved);
    text_format(&m.views, "{'buffer': 0, 'byteOffset': %zu, 'byteLength': 60, 'byteStride': 20}", offset);
    text_append(&m.accessors, "{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}, "
                              "{'bufferView': 0, 'byteOffset': 12, 'componentType': 5126, 'count': 3, 'type': 'VEC2'}");
    kiln_scene *scene = good(&m, "'attributes': {'POSITION': 0, 'TEXCOORD_0': 1}");
    assert_floats(scene_mesh(scene, 1)->positions, triangle_positions, 9);
    const float expected[6] = {0.25f, 0.5f, 0.75f, 1, 2, 3};
    assert_floats(mesh_primvar(scene_mesh(scene, 1), KILN_PRIMVAR_UV, 0)->values, expected, 6);
    kiln_scene_destroy(scene);
}

static const char sparse_format[] = "{%s'componentType': 5126, 'count': 3, 'type': 'VEC3', 'sparse': {'count': %d, 'indices': "
                                    "{'bufferView': 1, 'componentType': %d}, 'values': {'bufferView': 2}}}";

static mesh_json sparse(const char *base, int count, int type, const void *indices, size_t index_size) {
    static const float values[6] = {5, 6, 7, 8, 9, 10};
    mesh_json m = {0};
    size_t a = put(&m, triangle_positions, 36), b = put(&m, indices, index_size), c = put(&m, values, sizeof values);
    text_format(&m.views, "{'buffer': 0, 'byteOffset': %zu, 'byteLength': 36}, {'buffer': 0, 'byteOffset': %zu, "
                          "'byteLength': %zu}, {'buffer': 0, 'byteOffset': %zu, 'byteLength': 24}", a, b, index_size, c);
    text_format(&m.accessors, sparse_format, base, count, type);
    return m;
}

static void reads_sparse(void **state) {
    (void)state;
    const uint8_t i8[2] = {0, 2};
    const uint16_t i16[2] = {0, 2};
    const uint32_t i32[2] = {0, 2};
    const float over[9] = {5, 6, 7, 1, 0, 0, 8, 9, 10}, alone[9] = {5, 6, 7, 0, 0, 0, 8, 9, 10};
    const struct { int type; const void *data; size_t size; } rows[] = {{5121, i8, 2}, {5123, i16, 4}, {5125, i32, 8}};
    for (int i = 0; i < 3; i++) {
        mesh_json m = sparse("'bufferView': 0, ", 2, rows[i].type, rows[i].data, rows[i].size);
        kiln_scene *scene = good(&m, POSITION);
        assert_floats(scene_mesh(scene, 1)->positions, over, 9);
        kiln_scene_destroy(scene);
        m = sparse("", 2, rows[i].type, rows[i].data, rows[i].size); /* on zeros */
        scene = good(&m, POSITION);
        assert_floats(scene_mesh(scene, 1)->positions, alone, 9);
        kiln_scene_destroy(scene);
    }
}

static void refuses_bad_sparse(void **state) {
    (void)state;
    const uint8_t indices[2] = {0, 3}, good_ones[2] = {0, 2};
    mesh_json m = sparse("'bufferView': 0, ", 2, 5121, indices, 2);
    bad(&m, POSITION, KILN_CODE_RANGE, "attributes.POSITION", "for element 3 of 3");
    m = sparse("'bufferView': 0, ", 4, 5121, good_ones, 2);
    bad(&m, POSITION, KILN_CODE_RANGE, "accessors[0].sparse", "4 sparse values of 3");
    m = sparse("'bufferView': 0, ", 3, 5121, good_ones, 2);
    bad(&m, POSITION, KILN_CODE_RANGE, "accessors[0].sparse.indices", "beyond the 2 bytes");
    m = sparse("'bufferView': 0, ", 2, 5126, good_ones, 2);
    bad(&m, POSITION, KILN_CODE_RANGE, "accessors[0].sparse.indices", "no component type of indices");
}

/* byteOffset, count and stride at every edge of the view. */
static void refuses_what_is_out_of_range(void **state) {
    (void)state;
    static const struct { const char *view, *accessor, *where, *what; kiln_code code; } rows[] = {
        {"'byteLength': 36", "'count': 4", "accessors[0]", "beyond the 36 bytes", KILN_CODE_RANGE},
        {"'byteLength': 36", "'count': 3, 'byteOffset': 4", "accessors[0]", "beyond", KILN_CODE_RANGE},
        {"'byteLength': 35", "'count': 3", "accessors[0]", "beyond the 35 bytes", KILN_CODE_RANGE},
        {"'byteLength': 36, 'byteStride': 16", "'count': 3", "accessors[0]", "beyond", KILN_CODE_RANGE},
        {"'byteLength': 36, 'byteStride': 8", "'count': 2", "accessors[0]", "do not fit into the byteStride of 8", KILN_CODE_RANGE},
        {"'byteLength': 37", "'count': 3", "bufferViews[0]", "beyond the 36 of buffer 0", KILN_CODE_RANGE},
        {"'byteLength': 36, 'byteOffset': 1", "'count': 3", "bufferViews[0]", "beyond", KILN_CODE_RANGE},
        {"'byteLength': 36, 'byteOffset': 9007199254740992", "'count': 3", "bufferViews[0]", "beyond", KILN_CODE_RANGE},
        {"'byteLength': 36", "'count': 9007199254740992", "accessors[0]", "beyond", KILN_CODE_RANGE},
        {"'byteLength': 36", "'count': 3, 'byteOffset': 9007199254740992", "accessors[0]", "beyond", KILN_CODE_RANGE},
        {"'byteLength': 36", "'count': 0", "accessors[0]", "no elements", KILN_CODE_RANGE},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        mesh_json m = {0};
        put(&m, triangle_positions, 36);
        text_format(&m.views, "{'buffer': 0, %s}", rows[i].view);
        text_format(&m.accessors, "{'bufferView': 0, 'componentType': 5126, 'type': 'VEC3', %s}", rows[i].accessor);
        bad(&m, POSITION, rows[i].code, rows[i].where, rows[i].what);
    }
}

static void refuses_unknown_types(void **state) {
    (void)state;
    const int types[] = {0, 5124, 5127, 5130};
    for (size_t i = 0; i < 4; i++) {
        mesh_json m = {0};
        add(&m, triangle_positions, 36, 0, types[i], 1, "VEC3", "");
        char *rest = finish(&m, POSITION);
        char *json = document(m.data, m.size, rest);
        kiln_report *report = kiln_report_create();
        assert_null(import_text(json, report));
        assert_int_equal(kiln_report_exit_code(report), 3);
        kiln_report_destroy(report);
        free(json);
        free(rest);
    }
}

/* Zeros without a buffer view cost memory that no file holds. */
static void bounds_memory(void **state) {
    (void)state;
    mesh_json m = {0};
    add_triangle(&m);
    text_append(&m.accessors, ", {'componentType': 5126, 'count': 2000000000, 'type': 'VEC3'}");
    bad(&m, "'attributes': {'POSITION': 1}", KILN_CODE_LIMIT, "meshes[0]", "more than the memory limit");
}

static void warns_of_misalignment(void **state) {
    (void)state;
    char data[40] = {0};
    memcpy(data + 1, triangle_positions, 36);
    kiln_scene *scene = import_warned(data, sizeof data,
                                      "'bufferViews': [{'buffer': 0, 'byteLength': 40}], 'accessors': [{'bufferView': 0, "
                                      "'byteOffset': 1, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}], " TRIANGLE_MESH
                                      ", 'nodes': [{'mesh': 0}]",
                                      KILN_CODE_RANGE, "accessors[0]", "not aligned");
    assert_floats(scene_mesh(scene, 1)->positions, triangle_positions, 9);
    kiln_scene_destroy(scene);
}

static void wants_bytes_in_buffers(void **state) {
    (void)state;
    import_bad(NULL, 0, "'buffers': [{'byteLength': 36}], " TRIANGLE ", 'nodes': [{'mesh': 0}]", KILN_CODE_REFERENCE,
               "attributes.POSITION", "buffer 0 has neither");
    import_bad(NULL, 0, "'buffers': [{'byteLength': 36, 'uri': 'data:;base64,AAAA'}], " TRIANGLE, KILN_CODE_FILE_TRUNCATED,
               "buffers[0]", "byteLength is 36, but there are only 3 bytes");
    import_bad(NULL, 0, "'buffers': [{'byteLength': 36, 'uri': 'a.bin'}], " TRIANGLE, KILN_CODE_PATH_OUTSIDE,
               "buffers[0].uri", "no folder");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_component_types), cmocka_unit_test(reads_strides_and_offsets),
        cmocka_unit_test(reads_sparse),          cmocka_unit_test(refuses_bad_sparse),
        cmocka_unit_test(refuses_what_is_out_of_range), cmocka_unit_test(refuses_unknown_types),
        cmocka_unit_test(bounds_memory),         cmocka_unit_test(warns_of_misalignment),
        cmocka_unit_test(wants_bytes_in_buffers),
    };
    return cmocka_run_group_tests_name("accessor", tests, NULL, NULL);
}
