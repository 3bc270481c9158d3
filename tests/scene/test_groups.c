/* Where the light of a scene comes from, by name. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/groups.h"

typedef struct fixture { kiln_scene *scene; kiln_report *report; } fixture;

static int open_scene(void **state) {
    fixture *f = calloc(1, sizeof *f);
    f->scene = kiln_scene_create();
    f->report = kiln_report_create();
    *state = f;
    return 0;
}
static int close_scene(void **state) {
    fixture *f = *state;
    kiln_scene_destroy(f->scene);
    kiln_report_destroy(f->report);
    free(f);
    return 0;
}

static void add_light(fixture *f, const char *name) {
    kiln_light l = kiln_light_default();
    l.name = name;
    assert_true(kiln_scene_add_light(f->scene, &l, NULL, f->report));
}

/* A triangle that wears the material, if it is to be worn. */
static void add_material(fixture *f, const char *name, float emission, uint32_t layers, bool worn) {
    const float p[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t faces[3] = {0, 1, 2};
    kiln_material m = kiln_material_default();
    kiln_mesh_desc mesh = {.vertex_count = 3, .positions = p, .face_count = 1, .face_vertices = faces};
    m.name = name, m.layers = layers, m.emission.value[1] = emission;
    assert_true(kiln_scene_add_material(f->scene, &m, &mesh.material, f->report));
    if (worn) assert_true(kiln_scene_add_mesh(f->scene, &mesh, NULL, f->report));
}

static void has(const fixture *f, const char *const *wanted, uint32_t count) {
    const char *const *names;
    uint32_t found;
    assert_true(kiln_scene_light_groups(f->scene, &names, &found, f->report));
    assert_int_equal(found, count);
    for (uint32_t i = 0; i < count; i++) assert_string_equal(names[i], wanted[i]);
    free((void *)names);
}

static void an_empty_scene_has_surroundings(void **state) { has(*state, (const char *[]){"environment"}, 1); }

static void what_shines_is_listed_once(void **state) {
    fixture *f = *state;
    add_light(f, "key"), add_light(f, NULL), add_light(f, "rim"), add_light(f, "key");
    add_material(f, "dark", 0, 0, true), add_material(f, "lamp", 1, 0, true), add_material(f, "spare", 1, 0, false);
    add_material(f, NULL, 0, KILN_LAYER_UNLIT, true), add_material(f, "rim", 1, 0, true);
    has(f, (const char *[]){"key", "light_2", "rim", "lamp", "material_4", "environment"}, 6);
    light_groups g;
    assert_true(light_groups_make(f->scene, &g, f->report));
    assert_true(g.of_light[1] == 0 && g.of_light[2] == 1 && g.of_light[3] == 2 && g.of_light[4] == 0);
    assert_true(g.of_material[2] == 3 && g.of_material[4] == 4 && g.of_material[5] == 2 && g.of_environment == 5);
    light_groups_free(&g);
}

/* A name of 199 bytes and a character of two is cut before that. */
static void names_fit_channels(void **state) {
    char name[256];
    add_light(*state, "Key.001:a,b\n");
    memset(name, 'x', 199);
    strcpy(name + 199, "\xc3\xbc and so on");
    add_light(*state, name);
    name[199] = '\0';
    has(*state, (const char *[]){"Key_001_a_b_", name, "environment"}, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_empty_scene_has_surroundings, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(what_shines_is_listed_once, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(names_fit_channels, open_scene, close_scene)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
