#include "tests/importers/gltf/folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include "kiln/import.h"

#define SCENE TRIANGLE ", 'nodes': [{'mesh': 0}]"

/* As a glb with the triangle in its binary chunk. */
static kiln_text make_glb(void) {
    kiln_text json = {0}, glb = {0};
    char *rest = document(NULL, 0, "'buffers': [{'byteLength': 36}], " SCENE);
    text_append(&json, rest);
    free(rest);
    while (json.length % 4) text_append(&json, " ");
    const uint32_t header[] = {0x46546C67, 2, (uint32_t)(12 + 8 + json.length + 8 + 36), (uint32_t)json.length, 0x4E4F534A},
                   chunk[] = {36, 0x004E4942};
    text_append_bytes(&glb, (const char *)header, sizeof header);
    text_append_bytes(&glb, json.data, json.length);
    text_append_bytes(&glb, (const char *)chunk, sizeof chunk);
    text_append_bytes(&glb, (const char *)triangle_positions, 36);
    text_free(&json);
    return glb;
}

static const char *const names[] = {"a.gltf", "a.glb", "a.weird", "a.usda", "noise.glb", "with.gltf", "a.bin", "short.gltf", "folder.gltf"};

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    char *json = document(TRIANGLE_DATA, SCENE);
    put("a.gltf", json, strlen(json));
    put("a.weird", json, strlen(json));
    put("a.usda", "#usda 1.0\n", 10);
    put("noise.glb", "\x89PNG....", 8);
    free(json);
    kiln_text glb = make_glb();
    put("a.glb", glb.data, glb.length);
    text_free(&glb);
    json = document(NULL, 0, "'buffers': [{'byteLength': 36, 'uri': 'a.bin'}], " SCENE);
    put("with.gltf", json, strlen(json));
    free(json);
    json = document(NULL, 0, "'buffers': [{'byteLength': 100, 'uri': 'a.bin'}], " SCENE);
    put("short.gltf", json, strlen(json));
    free(json);
    json = document(NULL, 0, "'buffers': [{'byteLength': 36, 'uri': '.'}], " SCENE);
    put("folder.gltf", json, strlen(json));
    free(json);
    put("a.bin", triangle_positions, 36);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    char path[160];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        name_of(path, names[i]);
        unlink(path);
    }
    return rmdir(folder);
}

static void good(const char *name) {
    char path[160];
    name_of(path, name);
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    if (!kiln_import(path, NULL, &scene, report)) print_report(report);
    assert_non_null(scene);
    assert_true(kiln_scene_commit(scene, report));
    assert_int_equal(kiln_scene_count(scene).triangles, 1);
    assert_int_equal(kiln_report_size(report), 0);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
}

static void bad(const char *path, kiln_code code, const char *where, const char *what) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = (kiln_scene *)report;
    assert_false(kiln_import(path, NULL, &scene, report));
    assert_null(scene);
    assert_message(report, KILN_ERROR, code, where, what);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    assert_int_equal(kiln_report_exit_code(report), 3);
    kiln_report_destroy(report);
}

static void bad_in_folder(const char *name, kiln_code code, const char *where, const char *what) {
    char path[160];
    name_of(path, name);
    bad(path, code, where, what);
}

static void content_decides(void **state) {
    (void)state;
    good("a.gltf");
    good("a.glb");
    good("a.weird");
    good("with.gltf");
}

static void refuses_other_files(void **state) {
    (void)state;
    bad("/nowhere/a.gltf", KILN_CODE_FILE_MISSING, "/nowhere/a.gltf", "does not exist");
    bad(folder, KILN_CODE_FILE_UNREADABLE, folder, "directory");
    bad_in_folder("a.usda", KILN_CODE_FILE_FORMAT, "a.usda", ".usda");
    bad_in_folder("noise.glb", KILN_CODE_FILE_FORMAT, "noise.glb", "neither");
    bad_in_folder("short.gltf", KILN_CODE_FILE_TRUNCATED, "short.gltf: buffers[0]", "byteLength is 100");
    bad_in_folder("folder.gltf", KILN_CODE_FILE_UNREADABLE, "folder.gltf: buffers[0].uri", "directory");
}

static void reads_standard_input(void **state) {
    (void)state;
    char path[160];
    name_of(path, "a.glb");
    int kept = dup(STDIN_FILENO);
    assert_non_null(freopen(path, "rb", stdin));
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    assert_true(kiln_import("-", NULL, &scene, report));
    assert_int_equal(scene->instance_count, 1);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    name_of(path, "with.gltf"); /* which has no folder then */
    assert_non_null(freopen(path, "rb", stdin));
    bad("-", KILN_CODE_PATH_OUTSIDE, "standard input: buffers[0].uri", "no folder");
    dup2(kept, STDIN_FILENO);
    close(kept);
}

static void obeys_the_memory_limit(void **state) {
    (void)state;
    char path[160];
    name_of(path, "a.glb");
    for (uint64_t limit = 1; limit < 40000; limit += limit / 8 + 1) {
        kiln_report *report = kiln_report_create();
        kiln_import_options options = {.memory_limit = limit};
        kiln_scene *scene;
        if (kiln_import(path, &options, &scene, report)) kiln_scene_destroy(scene);
        else assert_int_equal(kiln_report_message(report, 0).code, KILN_CODE_LIMIT);
        kiln_report_destroy(report);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(content_decides),
        cmocka_unit_test(refuses_other_files),
        cmocka_unit_test(reads_standard_input),
        cmocka_unit_test(obeys_the_memory_limit),
    };
    return cmocka_run_group_tests_name("import", tests, set_up, tear_down);
}
