/* tests/importers/gltf/support.h: small glTF documents in memory, and what importing them says. */
#ifndef KILN_TESTS_IMPORTERS_GLTF_SUPPORT_H
#define KILN_TESTS_IMPORTERS_GLTF_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/text.h"
#include "importers/gltf/gltf.h"
#include "scene/scene.h"

/* "data:application/octet-stream;base64,…"; free(). */
static inline char *data_uri(const void *data, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *in = data;
    kiln_text text = {0};
    text_append(&text, "data:application/octet-stream;base64,");
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)in[i] << 16 | (uint32_t)(i + 1 < size ? in[i + 1] : 0) << 8 | (i + 2 < size ? in[i + 2] : 0);
        char out[4] = {digits[word >> 18], digits[word >> 12 & 63], i + 1 < size ? digits[word >> 6 & 63] : '=',
                       i + 2 < size ? digits[word & 63] : '='};
        text_append_bytes(&text, out, 4);
    }
    return text_take(&text);
}

/* A document: version 2.0, a buffer of these bytes (none for size 0), and the rest of the JSON. ' stands for ". free(). */
static inline char *document(const void *data, size_t size, const char *rest) {
    kiln_text text = {0};
    text_append(&text, "{\"asset\": {\"version\": \"2.0\"}");
    if (size) {
        char *uri = data_uri(data, size);
        text_format(&text, ", \"buffers\": [{\"byteLength\": %zu, \"uri\": \"%s\"}]", size, uri);
        free(uri);
    }
    if (*rest) text_append(&text, ", ");
    for (const char *c = rest; *c; c++) text_append_bytes(&text, *c == '\'' ? "\"" : c, 1);
    text_append(&text, "}");
    return text_take(&text);
}

/* NULL when the import failed. The scene is not committed. */
static inline kiln_scene *import_text(const char *json, kiln_report *report) {
    kiln_scene *scene = kiln_scene_create();
    assert_non_null(scene);
    kiln_import_options options = {.memory_limit = 64 << 20};
    uint64_t errors = kiln_report_count(report, KILN_ERROR);
    if (gltf_import_memory("test.gltf", json, strlen(json), NULL, &options, scene, report)) {
        assert_int_equal(kiln_report_count(report, KILN_ERROR), errors);
        return scene;
    }
    assert_true(kiln_report_count(report, KILN_ERROR) > errors);
    kiln_scene_destroy(scene);
    return NULL;
}

static inline void print_report(const kiln_report *report) {
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        print_message("  %s: %s: %s\n", kiln_code_name(m.code), m.where, m.what);
    }
}

/* Imports what must be right, without a word. */
static inline kiln_scene *import_good(const void *data, size_t size, const char *rest) {
    char *json = document(data, size, rest);
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_text(json, report);
    if (!scene || kiln_report_size(report)) print_report(report);
    assert_non_null(scene);
    assert_int_equal(kiln_report_size(report), 0);
    kiln_report_destroy(report);
    free(json);
    return scene;
}

/* Is there a message with these parts? */
static inline void assert_message(const kiln_report *report, kiln_severity severity, kiln_code code, const char *where,
                                  const char *what) {
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        if (m.severity == severity && m.code == code && strstr(m.where, where) && strstr(m.what, what)) return;
    }
    print_message("no message %s at '%s': '%s' among\n", kiln_code_name(code), where, what);
    print_report(report);
    fail();
}

/* Imports what must be refused, with one error. */
static inline void import_bad_text(const char *json, kiln_code code, const char *where, const char *what) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_text(json, report);
    if (scene) print_message("accepted: %.300s\n", json);
    assert_null(scene);
    assert_message(report, KILN_ERROR, code, where, what);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    kiln_report_destroy(report);
}

static inline void import_bad(const void *data, size_t size, const char *rest, kiln_code code, const char *where,
                              const char *what) {
    char *json = document(data, size, rest);
    import_bad_text(json, code, where, what);
    free(json);
}

/* Imports what is read with one warning. */
static inline kiln_scene *import_warned(const void *data, size_t size, const char *rest, kiln_code code,
                                        const char *where, const char *what) {
    char *json = document(data, size, rest);
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_text(json, report);
    if (!scene) print_report(report);
    assert_non_null(scene);
    assert_message(report, KILN_WARNING, code, where, what);
    kiln_report_destroy(report);
    free(json);
    return scene;
}

/* A triangle for documents whose subject is something else: three positions, and JSON for them as accessor 0. */
static const float triangle_positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
#define TRIANGLE_VIEWS "'bufferViews': [{'buffer': 0, 'byteLength': 36}], "
#define TRIANGLE_ACCESSORS "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}], "
#define TRIANGLE_MESH "'meshes': [{'name': 'm', 'primitives': [{'attributes': {'POSITION': 0}}]}]"
#define TRIANGLE TRIANGLE_VIEWS TRIANGLE_ACCESSORS TRIANGLE_MESH
#define TRIANGLE_DATA triangle_positions, sizeof triangle_positions

/* A PNG of one grey pixel. */
#define PIXEL \
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNoAAAAggCB2kUIOwAAAABJRU5ErkJggg=="

static inline void assert_floats(const float *values, const float *expected, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(values[i] - expected[i]) <= 1e-6f * (1 + fabsf(expected[i])))) {
            print_message("value %zu is %.9g, expected %.9g\n", i, (double)values[i], (double)expected[i]);
            fail();
        }
}

#endif
