/* What the importer makes of files, against texts that were read and found right. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "kiln/import.h"
#include "tests/assets.h"
#include "tests/golden/dump.h"
#include "tests/golden/golden.h"
#include "tests/golden/pairs.h"

/* The scene's dump, with its report behind it. The file's name stays out. */
static char *dump_file(const char *path) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    kiln_text text = {0};
    bool imported = kiln_import(path, NULL, &scene, report);
    if (imported) dump_scene(scene, &text);
    dump_report(report, strlen(path), &text);
    if (imported) kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    return text_take(&text);
}

/* Is this line one of the text's? Then it is struck out there. */
static bool strike(char *text, const char *line, size_t length) {
    for (char *at = text; *at; at += strcspn(at, "\n") + 1)
        if (strcspn(at, "\n") == length && memcmp(at, line, length) == 0) {
            at[0] = '\x01';
            return true;
        }
    return false;
}

static void append_missing(const char *lines, const char *other, const char *sign, kiln_text *out) {
    char *rest = strdup(other);
    for (const char *at = lines; *at; at += strcspn(at, "\n") + 1) {
        size_t length = strcspn(at, "\n");
        if (strike(rest, at, length)) continue;
        text_append(out, sign);
        text_append_bytes(out, at, length);
        text_append(out, "\n");
    }
    free(rest);
}

static char *dump_side(const char *name, const char *side) {
    kiln_text path = {0};
    text_format(&path, "%s/gltf/pairs/%s_%s.gltf", KILN_TEST_DATA, name, side);
    char *dump = dump_file(path.data);
    text_free(&path);
    return dump;
}

/* Two files that differ in one feature give two scenes, which differ in the lines that belong to it. */
static void features_make_a_difference(void **state) {
    (void)state;
    size_t count;
    char **names = pair_names(&count);
    assert_true(count >= 90);
    kiln_text text = {0};
    char *base = dump_side("node_translation", "a");
    text_format(&text, "== the scene that most pairs change\n%s", base);
    free(base);
    for (size_t i = 0; i < count; i++) {
        char *a = dump_side(names[i], "a"), *b = dump_side(names[i], "b");
        if (strcmp(a, b) == 0) fail_msg("%s makes no difference", names[i]);
        text_format(&text, "== %s\n", names[i]);
        append_missing(a, b, "-", &text);
        append_missing(b, a, "+", &text);
        free(a);
        free(b);
    }
    pair_names_free(names, count);
    assert_true(golden_matches("gltf/pairs.dump", text.data));
    text_free(&text);
}

static void describe_asset(const char *path, kiln_text *out) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    if (kiln_import(path, NULL, &scene, report)) {
        if (kiln_scene_commit(scene, report)) dump_summary(scene, out);
        kiln_scene_destroy(scene);
    }
    dump_report(report, strlen(path), out);
    kiln_report_destroy(report);
}

static void assets_are_what_they_were(void **state) {
    (void)state;
    const char *root = assets_or_skip();
    static const char *const suffixes[] = {".gltf", ".glb", NULL};
    char folder[4200];
    snprintf(folder, sizeof folder, "%s/gltf", root);
    assert_true(golden_matches_files("gltf/assets.summary", folder, suffixes, describe_asset));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(features_make_a_difference),
        cmocka_unit_test(assets_are_what_they_were),
    };
    return cmocka_run_group_tests_name("golden gltf", tests, NULL, NULL);
}
