#include "tests/importers/gltf/support.h"

#include <unistd.h>

#include "importers/gltf/extensions.h"

static void table_names_each_once(void **state) {
    (void)state;
    for (size_t i = 0; i < extension_row_count; i++) {
        assert_int_equal(extension_rows[i].support == EXTENSION_LEFT_OUT, extension_rows[i].without != NULL);
        for (size_t k = 0; k < i; k++) assert_string_not_equal(extension_rows[i].name, extension_rows[k].name);
    }
}

static void required_ones_must_be_read(void **state) {
    (void)state;
    for (size_t i = 0; i < extension_row_count; i++) {
        char rest[700];
        snprintf(rest, sizeof rest, TRIANGLE ", 'nodes': [{'mesh': 0}], 'extensionsRequired': ['%s']", extension_rows[i].name);
        if (extension_rows[i].support == EXTENSION_LEFT_OUT)
            import_bad(TRIANGLE_DATA, rest, KILN_CODE_EXTENSION, "extensionsRequired[0]", extension_rows[i].name);
        else kiln_scene_destroy(import_good(TRIANGLE_DATA, rest));
    }
    import_bad(NULL, 0, "'extensionsRequired': ['KHR_texture_transform', 'ACME_hologram']", KILN_CODE_EXTENSION,
               "extensionsRequired[1]", "the file requires ACME_hologram, which kiln does not read");
}

static void the_remedy_lists_what_is_read(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    assert_null(import_text("{\"asset\": {\"version\": \"2.0\"}, \"extensionsRequired\": [\"X\"]}", report));
    assert_non_null(strstr(kiln_report_message(report, 0).remedy, "KHR_materials_ior, KHR_materials_iridescence"));
    kiln_report_destroy(report);
}

static void optional_ones_are_one_warning(void **state) {
    (void)state;
    for (size_t i = 0; i < extension_row_count; i++) {
        char rest[700];
        snprintf(rest, sizeof rest, TRIANGLE ", 'nodes': [{'mesh': 0}], 'extensionsUsed': ['%s']", extension_rows[i].name);
        kiln_scene_destroy(extension_rows[i].support == EXTENSION_LEFT_OUT
                               ? import_warned(TRIANGLE_DATA, rest, KILN_CODE_IGNORED, "extensionsUsed[0]", extension_rows[i].name)
                               : import_good(TRIANGLE_DATA, rest));
    }
    kiln_scene_destroy(import_warned(TRIANGLE_DATA, TRIANGLE ", 'nodes': [{'mesh': 0}], 'extensionsUsed': ['ACME_hologram']",
                                     KILN_CODE_IGNORED, "extensionsUsed[0]", "ACME_hologram is not known"));
}

/* Exporters forget to declare. Each object counts, in extensions of extensions too; extras are not looked into. */
static void undeclared_ones_are_found_and_counted(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    char *json = document(TRIANGLE_DATA, TRIANGLE ", 'nodes': [{'mesh': 0, 'extras': {'extensions': {'ACME_extra': {}}}}], "
                          "'extensionsUsed': ['EXT_lights_ies', 'KHR_gaussian_splatting'], "
                          "'materials': [{'extensions': {'EXT_lights_ies': {}}}, {}, "
                          "{'extensions': {'KHR_materials_scatter': {'scatterTexture': {'index': 0, 'extensions': {'ACME_foo': {}}}}, "
                          "'ACME_foo': {}}}, {'extensions': {'KHR_materials_scatter': {}, 'KHR_materials_ior': {}}}]");
    kiln_scene *scene = import_text(json, report);
    assert_non_null(scene);
    static const struct { const char *where, *what; uint64_t count; } rows[] = {
        {"materials[0].extensions.EXT_lights_ies", "EXT_lights_ies is left out", 1},
        {"extensionsUsed[1]", "KHR_gaussian_splatting is left out", 1},
        {"materials[2].extensions.KHR_materials_scatter", "KHR_materials_scatter is left out", 2},
        {"materials[2].extensions.KHR_materials_scatter.scatterTexture.extensions.ACME_foo", "ACME_foo is not known", 2}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_message(report, KILN_WARNING, KILN_CODE_IGNORED, rows[i].where, rows[i].what);
        for (size_t k = 0; k < kiln_report_size(report); k++) {
            kiln_message m = kiln_report_message(report, k);
            if (strstr(m.what, rows[i].what)) assert_int_equal(m.count, rows[i].count);
        }
    }
    assert_int_equal(kiln_report_size(report), 4);
    static const char *const listed[] = {"EXT_lights_ies", "KHR_gaussian_splatting", "KHR_materials_scatter",
                                         "ACME_foo", "KHR_materials_ior"};
    assert_int_equal(scene->source.extension_count, 5);
    for (int i = 0; i < 5; i++) assert_string_equal(scene->source.extensions[i].name, listed[i]);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    free(json);
}

static void repeated_arrays_are_refused(void **state) {
    (void)state;
    import_bad(NULL, 0, "'buffers': [], 'buffers': []", KILN_CODE_SYNTAX, "buffers", "twice");
    import_bad(NULL, 0, "'extensionsRequired': [], 'extensionsRequired': []", KILN_CODE_SYNTAX, "extensionsRequired", "twice");
}

/* A key with an escape reaches the parser behind as "buffers": nothing may be opened for it, not even what fits. */
static void escaped_keys_open_nothing(void **state) {
    (void)state;
    char path[] = "/tmp/kiln-escaped-XXXXXX", json[200];
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, "0123456789", 10), 10);
    close(fd);
    snprintf(json, sizeof json, "{\"asset\": {\"version\": \"2.0\"}, \"b\\u0075ffers\": [{\"byteLength\": 10, \"uri\": \"%s\"}]}", path);
    import_bad_text(json, KILN_CODE_SYNTAX, "test.gltf", "not found");
    unlink(path);
}

static void motion_is_one_warning_each(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    char *json = document(TRIANGLE_DATA, TRIANGLE_VIEWS TRIANGLE_ACCESSORS
                          "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'targets': [{'POSITION': 0}, {'POSITION': 0}]}, "
                          "{'attributes': {'POSITION': 0}, 'targets': [{'POSITION': 0}]}]}], 'nodes': [{'mesh': 0, 'skin': 0}], "
                          "'skins': [{'joints': [0]}, {'joints': [0]}], 'animations': [{'channels': [{'sampler': 0, 'target': "
                          "{'node': 0, 'path': 'translation'}}], 'samplers': [{'input': 0, 'output': 0}]}]");
    kiln_scene *scene = import_text(json, report);
    assert_non_null(scene);
    assert_int_equal(kiln_report_count(report, KILN_WARNING), 3);
    assert_message(report, KILN_WARNING, KILN_CODE_IGNORED, "animations[0]", "1 animation is left out");
    assert_message(report, KILN_WARNING, KILN_CODE_IGNORED, "skins[0]", "2 skins are left out");
    assert_message(report, KILN_WARNING, KILN_CODE_IGNORED, "meshes[0].primitives[0]",
                   "morph targets of 2 primitives are left out");
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    free(json);
}

static void checks_motion(void **state) {
    (void)state;
    static const struct { const char *rest, *where, *what; } rows[] = {
        {"'nodes': [{}], 'skins': [{'joints': [0, 3]}]", "skins[0].joints[1]", "node 3"},
        {"'nodes': [{}], 'skins': [{'joints': [0], 'skeleton': 1}]", "skins[0].skeleton", "node 1"},
        {"'nodes': [{}], 'skins': [{'joints': [0], 'inverseBindMatrices': 1}]", "skins[0].inverseBindMatrices", "accessor 1"},
        {"'nodes': [{}], 'animations': [{'channels': [{'sampler': 1, 'target': {'node': 0, 'path': 'scale'}}], 'samplers': []}]",
         "animations[0].channels[0].sampler", "sampler 1"},
        {"'animations': [{'channels': [{'sampler': 0, 'target': {'node': 4, 'path': 'scale'}}], 'samplers': [{'input': 0, 'output': 0}]}]",
         "animations[0].channels[0].target.node", "node 4"},
        {"'animations': [{'channels': [], 'samplers': [{'input': 0, 'output': 2}]}]", "animations[0].samplers[0].output", "accessor 2"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_text rest = {0};
        text_format(&rest, TRIANGLE ", %s", rows[i].rest);
        import_bad(TRIANGLE_DATA, rest.data, KILN_CODE_REFERENCE, rows[i].where, rows[i].what);
        text_free(&rest);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_names_each_once),
        cmocka_unit_test(required_ones_must_be_read),
        cmocka_unit_test(the_remedy_lists_what_is_read),
        cmocka_unit_test(optional_ones_are_one_warning),
        cmocka_unit_test(undeclared_ones_are_found_and_counted),
        cmocka_unit_test(repeated_arrays_are_refused),
        cmocka_unit_test(escaped_keys_open_nothing),
        cmocka_unit_test(motion_is_one_warning_each),
        cmocka_unit_test(checks_motion),
    };
    return cmocka_run_group_tests_name("extensions", tests, NULL, NULL);
}
