#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "tests/cli/run.h"

static void assert_has(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("'%s' is missing in\n%s", part, text);
}

static void assets_are_shown(void **state) {
    const place *p = *state;
    result r = run(p, "inspect", PAIR("light_spot_b"));
    assert_int_equal(r.code, 0);
    assert_int_equal(r.err_size, 0);
    static const char *const parts[] = {"glTF 2.0", "KHR_lights_punctual", "triangles",   "size ",  "Instances",
                                        "Meshes",   "Materials",           "Lights",      "spot",   " cd",
                                        "Cameras",  "Rendering",           "1024 x 1024", "memory "};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) assert_has(r.out, parts[i]);
    assert_int_equal(files_in(p), 0);
    result_free(&r);
}

/* The hierarchy of the file, indented, with what its nodes hold; and the same with matrices for programs. */
static void the_tree_is_shown(void **state) {
    result r = run(*state, "inspect", PAIR("node_hierarchy_b"));
    assert_int_equal(r.code, 0);
    assert_has(r.out, "\nNodes\n    0  parent\n    1    sheet: mesh 0 ");
    assert_has(r.out, "\n    2  eye: camera 0 ");
    assert_has(r.out, "\n    3  sun: light 0 ");
    result_free(&r);
    r = run(*state, "inspect", PAIR("node_hierarchy_b"), "--json");
    json_t *json = json_loads(r.out, 0, NULL), *nodes = json_object_get(json, "nodes"), *node;
    size_t i, meshes = 0, cameras = 0, children = 0;
    json_array_foreach(nodes, i, node) {
        assert_int_equal(json_array_size(json_object_get(node, "matrix")), 16);
        meshes += json_is_integer(json_object_get(node, "mesh"));
        cameras += json_is_integer(json_object_get(node, "camera"));
        children += json_is_integer(json_object_get(node, "parent"));
    }
    assert_true(meshes == 1 && cameras == 1 && children >= 1);
    const json_t *instance = json_array_get(json_object_get(json, "instances"), 0);
    assert_int_equal(json_array_size(json_object_get(instance, "matrix")), 16);
    assert_int_equal(json_array_size(json_object_get(instance, "materials")), 1);
    json_decref(json);
    result_free(&r);
}

static void textures_are_shown_with_their_transfer(void **state) {
    result r = run(*state, "inspect", PAIR("base_color_texture_a"));
    assert_int_equal(r.code, 0);
    assert_has(r.out, "base_color ");
    assert_has(r.out, ", srgb, uv 0");
    assert_has(r.out, "PNG");
    result_free(&r);
}

static void json_has_the_same(void **state) {
    result r = run(*state, "inspect", PAIR("light_spot_b"), "--json", "--size", "64x32");
    assert_int_equal(r.code, 0);
    json_t *json = json_loads(r.out, 0, NULL);
    assert_non_null(json);
    const json_t *rendering = json_object_get(json, "rendering");
    assert_int_equal(json_integer_value(json_object_get(rendering, "width")), 64);
    assert_true(json_array_size(json_object_get(json, "lights")) > 0);
    json_decref(json);
    result_free(&r);
}

static void effects_are_shown_with_those_who_call_for_them(void **state) {
    result r = run(*state, "inspect", PAIR("normal_texture_b"));
    assert_has(r.out, "\nEffects\n");
    assert_has(r.out, "\n  normal-maps          by material 0 cloth");
    assert_has(r.out, "\n  not called for       thin-lens, motion, alpha,");
    result_free(&r);
    r = run(*state, "inspect", PAIR("normal_texture_b"), "--effects", "-normal-maps,+sheen", "--json");
    json_t *json = json_loads(r.out, 0, NULL), *row;
    size_t i;
    json_array_foreach(json_object_get(json, "effects"), i, row) {
        const char *name = json_string_value(json_object_get(row, "name"));
        bool runs = json_is_true(json_object_get(row, "runs"));
        if (strcmp(name, "normal-maps") == 0) assert_false(runs);
        if (strcmp(name, "sheen") == 0) assert_true(runs && json_is_false(json_object_get(row, "called")));
    }
    assert_true(i > 20);
    json_decref(json);
    result_free(&r);
}

static void warnings_are_on_standard_error_and_strict_counts_them(void **state) {
    result r = run(*state, "inspect", PAIR("mode_lines_b"));
    assert_int_equal(r.code, 0);
    assert_has(r.err, "warning: ");
    result_free(&r);
    r = run(*state, "inspect", PAIR("mode_lines_b"), "--strict");
    assert_int_equal(r.code, 1);
    assert_int_equal(r.out_size, 0);
    result_free(&r);
}

/* A machine that reads learns what went wrong where it reads everything else. */
static void failures_are_json_too(void **state) {
    const place *p = *state;
    const char *const commands[] = {"inspect", "render"};
    for (int i = 0; i < 2; i++) {
        result r = run(p, commands[i], "missing.glb", "--json");
        assert_int_equal(r.code, 3);
        json_t *json = json_loads(r.out, 0, NULL);
        assert_non_null(json);
        assert_int_equal(json_integer_value(json_object_get(json, "exit_code")), 3);
        assert_int_equal(json_array_size(json_object_get(json, "errors")), 1);
        assert_non_null(json_object_get(json, "warnings"));
        json_decref(json);
        result_free(&r);
    }
    result r = run(p, "render", PAIR("unlit_a"), "--size", "8x8", "--noise", "0.01%", "--spp", "2", "--json");
    assert_int_equal(r.code, 4);
    assert_non_null(strstr(r.out, "\"exit_code\": 4"));
    result_free(&r);
    r = run(p, "inspect", PAIR("unlit_a"), "--json");
    assert_non_null(strstr(r.out, "\"exit_code\": 0"));
    result_free(&r);
}

static void the_machine_is_shown(void **state) {
    result r = run(*state, "info");
    assert_int_equal(r.code, 0);
    static const char *const parts[] = {
        "Embree", "OpenColorIO", "OpenSubdiv", "threads", "kernels", "embedded kiln config", "Khronos PBR Neutral",
        "ACES",   ".glb",        ".exr"};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) assert_has(r.out, parts[i]);
    result_free(&r);
    r = run(*state, "info", "--json");
    json_t *json = json_loads(r.out, 0, NULL);
    assert_non_null(json_object_get(json, "versions"));
    json_decref(json);
    result_free(&r);
    assert_refused(*state, 3, "does not exist", "info", "--ocio", "missing.ocio");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        CLI_TEST(assets_are_shown), CLI_TEST(the_tree_is_shown), CLI_TEST(textures_are_shown_with_their_transfer), CLI_TEST(json_has_the_same),
        CLI_TEST(effects_are_shown_with_those_who_call_for_them),
        CLI_TEST(warnings_are_on_standard_error_and_strict_counts_them), CLI_TEST(failures_are_json_too),
        CLI_TEST(the_machine_is_shown)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
