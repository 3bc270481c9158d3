/* Files that a user may really have: each gives one clear line and the exit class for invalid input. */
#include "tests/importers/gltf/folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include "kiln/import.h"

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    put("a.bin", triangle_positions, 36);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    static const char *const names[] = {"a.bin", "file", "zero.png"};
    char path[160];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        name_of(path, names[i]);
        unlink(path);
    }
    return rmdir(folder);
}

/* The line names the file and the place in it, and says what is wrong and what to do. */
static void one_clear_line(const char *path, kiln_code code, const char *where, const char *what) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    assert_false(kiln_import(path, NULL, &scene, report));
    assert_null(scene);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    assert_int_equal(kiln_report_exit_code(report), 3);
    kiln_message m = kiln_report_message(report, kiln_report_size(report) - 1);
    bool right = m.code == code && strncmp(m.where, path, strlen(path)) == 0 && strstr(m.where, where) && strstr(m.what, what) &&
                 *m.remedy && !strchr(m.what, '\n');
    if (!right) print_message("%s: %s: %s (%s)\n", kiln_code_name(m.code), m.where, m.what, m.remedy);
    assert_true(right);
    kiln_report_destroy(report);
}

static void bad_file(const void *data, size_t size, kiln_code code, const char *where, const char *what) {
    char path[160];
    put("file", data, size);
    name_of(path, "file");
    one_clear_line(path, code, where, what);
}

static void bad_json(const char *rest, kiln_code code, const char *where, const char *what) {
    char *json = document(NULL, 0, rest);
    bad_file(json, strlen(json), code, where, what);
    free(json);
}

static void bad_scene(const char *rest, kiln_code code, const char *where, const char *what) {
    char *json = document(TRIANGLE_DATA, rest);
    bad_file(json, strlen(json), code, where, what);
    free(json);
}

static void missing_empty_and_folders(void **state) {
    (void)state;
    char path[160];
    name_of(path, "gone.gltf");
    one_clear_line(path, KILN_CODE_FILE_MISSING, "", "does not exist");
    one_clear_line(folder, KILN_CODE_FILE_UNREADABLE, "", "directory");
    bad_file("", 0, KILN_CODE_FILE_TRUNCATED, "", "empty");
    bad_file("   ", 3, KILN_CODE_FILE_FORMAT, "", "neither");
}

static void wrong_magic(void **state) {
    (void)state;
    bad_file("glTG\2\0\0\0", 8, KILN_CODE_FILE_FORMAT, "", "neither a glb");
    bad_file("glTF", 4, KILN_CODE_FILE_TRUNCATED, "", "inside its header");
    bad_file("glTF\1\0\0\0\x14\0\0\0\0\0\0\0\0\0\0\0", 20, KILN_CODE_FILE_FORMAT, "", "version 1");
}

static void nested_json(void **state) {
    (void)state;
    enum { DEPTH = 200000 };
    char *deep = malloc(6 * DEPTH);
    memset(deep, '[', DEPTH);
    bad_file(deep, DEPTH, KILN_CODE_SYNTAX, "line 1, column 129", "nested");
    for (int i = 0; i < DEPTH; i++) memcpy(deep + 5 * i, "{\"a\":", 5);
    bad_file(deep, 5 * DEPTH, KILN_CODE_SYNTAX, "line 1", "nested");
    memcpy(deep, "{\"asset\":{\"version\":\"2.0\"},\"extras\":", 36); /* where no property is of interest */
    memset(deep + 36, '[', DEPTH);
    bad_file(deep, 36 + DEPTH, KILN_CODE_SYNTAX, "line 1", "nested");
    free(deep);
}

static void missing_parts(void **state) {
    (void)state;
    bad_json("'buffers': [{'byteLength': 36, 'uri': 'gone.bin'}], " TRIANGLE, KILN_CODE_FILE_MISSING, "buffers[0].uri",
             "gone.bin does not exist");
    bad_json("'images': [{'uri': 'gone.png'}], 'textures': [{'source': 0}], 'materials': [{'normalTexture': {'index': 0}}]",
             KILN_CODE_FILE_MISSING, "images[0].uri", "gone.png does not exist");
    bad_json("'buffers': [{'byteLength': 37, 'uri': 'a.bin'}]", KILN_CODE_FILE_TRUNCATED, "buffers[0]", "37");
    bad_json("'buffers': [{'byteLength': 36, 'uri': '.'}]", KILN_CODE_FILE_UNREADABLE, "buffers[0].uri", "directory");
    bad_json("'buffers': [{'byteLength': 36, 'uri': 'a.bin/'}]", KILN_CODE_FILE_MISSING, "buffers[0].uri", "does not exist");
}

static void paths_that_leave_the_folder(void **state) {
    (void)state;
    static const char *const uris[] = {"../secret", "%2e%2e/secret", "..%2fsecret", "a/../../secret", "/etc/passwd", "file:///etc/passwd",
                                       "http://localhost/a.bin", "C:\\\\a.bin", "..\\\\a.bin", "%00a.bin", "\\u002e\\u002e/secret"};
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        char rest[200];
        snprintf(rest, sizeof rest, "'buffers': [{'byteLength': 36, 'uri': '%s'}]", uris[i]);
        bad_json(rest, KILN_CODE_PATH_OUTSIDE, "buffers[0].uri", "");
        snprintf(rest, sizeof rest, "'images': [{'uri': '%s'}], 'textures': [{'source': 0}], 'materials': [{'normalTexture': {'index': 0}}]", uris[i]);
        bad_json(rest, KILN_CODE_PATH_OUTSIDE, "images[0].uri", "");
    }
}

static void a_symbolic_link_that_leaves(void **state) {
    (void)state;
    char path[160];
    name_of(path, "zero.png");
    unlink(path);
    assert_int_equal(symlink("/etc/passwd", path), 0);
    bad_json("'buffers': [{'byteLength': 3, 'uri': 'zero.png'}]", KILN_CODE_PATH_OUTSIDE, "buffers[0].uri", "symbolic link");
    unlink(path);
}

static void indices_out_of_range(void **state) {
    (void)state;
    bad_scene(TRIANGLE_VIEWS TRIANGLE_ACCESSORS "'meshes': [{'primitives': [{'attributes': {'POSITION': 4}}]}]", KILN_CODE_REFERENCE,
              "meshes[0].primitives[0].attributes.POSITION", "accessor 4 does not exist");
    bad_scene(TRIANGLE_VIEWS TRIANGLE_ACCESSORS "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 9}]}]",
              KILN_CODE_REFERENCE, "meshes[0].primitives[0].indices", "accessor 9 does not exist");
    bad_scene(TRIANGLE ", 'nodes': [{'mesh': 4294967296}]", KILN_CODE_RANGE, "nodes[0].mesh", "too large");
    bad_scene("'bufferViews': [{'buffer': 0, 'byteLength': 36}, {'buffer': 0, 'byteLength': 3}], 'accessors': ["
              "{'bufferView': 0, 'componentType': 5126, 'count': 2, 'type': 'VEC3'}, "
              "{'bufferView': 0, 'byteOffset': 14, 'componentType': 5121, 'count': 3, 'type': 'SCALAR'}], "
              "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1}]}], 'nodes': [{'mesh': 0}]",
              KILN_CODE_RANGE, "meshes[0].primitives[0].indices", "index 0 is 128, but there are only 2 vertices");
    bad_scene("'bufferViews': [{'buffer': 0, 'byteOffset': 30, 'byteLength': 36}]", KILN_CODE_RANGE, "bufferViews[0]", "beyond");
}

static void loops(void **state) {
    (void)state;
    bad_scene(TRIANGLE ", 'nodes': [{'children': [1]}, {'children': [0]}], 'scenes': [{'nodes': [0]}]", KILN_CODE_REFERENCE, "nodes[0]",
              "its own ancestor");
}

static void positions_that_are_not_numbers(void **state) {
    (void)state;
    const float values[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, values[i]};
        char *json = document(positions, sizeof positions, TRIANGLE ", 'nodes': [{'mesh': 0}]");
        bad_file(json, strlen(json), KILN_CODE_GEOMETRY, "meshes[0]", "vertex 2");
        free(json);
    }
    bad_json("'nodes': [{'translation': [NaN, 0, 0]}]", KILN_CODE_SYNTAX, "line 1", "NaN");
}

static void an_image_of_no_size(void **state) {
    (void)state;
    static const unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R', 0, 0, 0, 0, 0, 0, 0, 4,
                                        8, 2, 0, 0, 0, 0, 0, 0, 0};
    put("zero.png", png, sizeof png);
    const char *rest = "'images': [{'uri': 'zero.png'}], 'textures': [{'source': 0}], 'materials': [{'normalTexture': {'index': 0}}]";
    char *json = document(NULL, 0, rest), path[160];
    put("file", json, strlen(json));
    name_of(path, "file");
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    assert_false(kiln_import(path, NULL, &scene, report));
    assert_int_equal(kiln_report_exit_code(report), 3);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    assert_non_null(strstr(kiln_report_message(report, 0).where, "images[0]"));
    kiln_report_destroy(report);
    free(json);
}

/* Every 7th length of a glb. */
static void truncated_glb(void **state) {
    (void)state;
    kiln_text glb = {0}, json = {0};
    char *rest = document(NULL, 0, "'buffers': [{'byteLength': 36}], " TRIANGLE ", 'nodes': [{'mesh': 0}]");
    text_append(&json, rest);
    while (json.length % 4) text_append(&json, " ");
    const uint32_t head[] = {0x46546C67, 2, (uint32_t)(64 + json.length), (uint32_t)json.length, 0x4E4F534A}, chunk[] = {36, 0x004E4942};
    text_append_bytes(&glb, (const char *)head, sizeof head);
    text_append_bytes(&glb, json.data, json.length);
    text_append_bytes(&glb, (const char *)chunk, sizeof chunk);
    text_append_bytes(&glb, (const char *)triangle_positions, 36);
    char path[160];
    name_of(path, "file");
    for (size_t size = 0; size < glb.length; size += 7) {
        put("file", glb.data, size);
        kiln_report *report = kiln_report_create();
        kiln_scene *scene;
        assert_false(kiln_import(path, NULL, &scene, report));
        assert_int_equal(kiln_report_exit_code(report), 3);
        kiln_code code = kiln_report_message(report, 0).code;
        assert_true(code == KILN_CODE_FILE_TRUNCATED || (size < 4 && code == KILN_CODE_FILE_FORMAT));
        kiln_report_destroy(report);
    }
    /* Cut in the middle, but with a header that agrees: the JSON, or the buffer, is what ends too early. */
    uint32_t shorter = (uint32_t)(glb.length - 12), left = 24;
    memcpy(glb.data + 8, &shorter, 4);
    memcpy(glb.data + 20 + json.length, &left, 4);
    bad_file(glb.data, shorter, KILN_CODE_FILE_TRUNCATED, "buffers[0]", "byteLength is 36, but there are only 24 bytes");
    text_free(&glb);
    text_free(&json);
    free(rest);
}

/* Small files that ask for a lot. */
static void bombs(void **state) {
    (void)state;
    char path[160];
    name_of(path, "file");
    static const char *const rests[] = {
        "'accessors': [{'componentType': 5126, 'count': 4000000000, 'type': 'VEC3'}], " TRIANGLE_MESH ", 'nodes': [{'mesh': 0}]",
        TRIANGLE_VIEWS "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}, "
                       "{'componentType': 5126, 'count': 4000000000, 'type': 'VEC3'}], " TRIANGLE_MESH
                       ", 'nodes': [{'mesh': 0, 'extensions': {'EXT_mesh_gpu_instancing': {'attributes': {'TRANSLATION': 1}}}}]",
    };
    for (size_t i = 0; i < sizeof rests / sizeof *rests; i++) {
        char *json = document(TRIANGLE_DATA, rests[i]);
        put("file", json, strlen(json));
        kiln_report *report = kiln_report_create();
        kiln_import_options options = {.memory_limit = 1 << 30};
        kiln_scene *scene;
        assert_false(kiln_import(path, &options, &scene, report));
        assert_message(report, KILN_ERROR, KILN_CODE_LIMIT, "", "memory limit");
        kiln_report_destroy(report);
        free(json);
    }
    /* A million small values: each costs the parser a hundred times its two bytes. */
    kiln_text text = {0};
    text_append(&text, "{\"asset\": {\"version\": \"2.0\"}, \"extras\": [1");
    for (int i = 0; i < 1000000; i++) text_append(&text, ",1");
    text_append(&text, "]}");
    put("file", text.data, text.length);
    kiln_report *report = kiln_report_create();
    kiln_import_options options = {.memory_limit = 64 << 20};
    kiln_scene *scene;
    assert_false(kiln_import(path, &options, &scene, report));
    assert_message(report, KILN_ERROR, KILN_CODE_LIMIT, "", "memory limit");
    kiln_report_destroy(report);
    text_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_empty_and_folders),
        cmocka_unit_test(wrong_magic),
        cmocka_unit_test(nested_json),
        cmocka_unit_test(missing_parts),
        cmocka_unit_test(paths_that_leave_the_folder),
        cmocka_unit_test(a_symbolic_link_that_leaves),
        cmocka_unit_test(indices_out_of_range),
        cmocka_unit_test(loops),
        cmocka_unit_test(positions_that_are_not_numbers),
        cmocka_unit_test(an_image_of_no_size),
        cmocka_unit_test(truncated_glb),
        cmocka_unit_test(bombs),
    };
    return cmocka_run_group_tests_name("bad gltf", tests, set_up, tear_down);
}
