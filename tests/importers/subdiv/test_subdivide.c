/* The whole line: options, views, limits, threads, motion; hard inputs end in rows that say why. */
#include "tests/importers/subdiv/shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kiln/import.h"

typedef struct fixture {
    kiln_scene *scene;
    kiln_report *report;
    kiln_subdivision_result *rows;
    uint32_t count;
} fixture;

static int setup(void **state) {
    static fixture f;
    f = (fixture){kiln_scene_create(), kiln_report_create(), NULL, 0};
    *state = &f;
    return !f.scene || !f.report;
}
static int teardown(void **state) {
    fixture *f = *state;
    kiln_scene_destroy(f->scene);
    kiln_report_destroy(f->report);
    free(f->rows);
    return 0;
}

static void run(fixture *f, kiln_subdivide_options options) {
    free(f->rows);
    f->rows = NULL;
    assert_true(kiln_subdivide(f->scene, &options, &f->rows, &f->count, f->report));
    assert_int_equal(f->count, f->scene->mesh_count);
}

static void place(fixture *f, kiln_id mesh, double scale, double z) {
    mat4 m = {{scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, 0, 0, z, 1}};
    kiln_instance_desc desc = {.mesh = mesh, .time_count = 1, .transforms = m.m};
    assert_true(kiln_scene_add_instance(f->scene, &desc, NULL, f->report));
}

static void off_and_level_are_obeyed(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    shape_add(f->scene, &cube, f->report);
    run(f, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_OFF});
    assert_true(!f->rows[0].refined && !strcmp(f->rows[0].reason, "subdivision is off"));
    assert_int_equal(scene_mesh(f->scene, 1)->face_count, 6);
    run(f, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 3});
    assert_true(f->rows[0].refined && !strcmp(f->rows[0].reason, "asked for by the command"));
    const kiln_mesh *m = scene_mesh(f->scene, 1);
    assert_int_equal(m->face_count, 6 * 64);
    assert_int_equal(m->subdivision.scheme, KILN_SCHEME_NONE); /* once is enough: a limit surface is no cage */
    run(f, (kiln_subdivide_options){0});
    assert_false(f->rows[0].refined);
}

static void schemes_may_be_given(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    const struct { kiln_scheme scheme; uint32_t faces, size; } cases[] = {
        {KILN_SCHEME_CATMULL_CLARK, 24, 4}, {KILN_SCHEME_LOOP, 48, 3}, {KILN_SCHEME_BILINEAR, 24, 4}};
    for (uint32_t i = 0; i < 3; i++) {
        kiln_scene *scene = kiln_scene_create();
        shape_add(scene, &cube, f->report);
        kiln_subdivide_options options = {.mode = KILN_SUBDIVIDE_LEVEL, .level = 1, .scheme = cases[i].scheme};
        assert_true(kiln_subdivide(scene, &options, NULL, NULL, f->report));
        assert_int_equal(scene_mesh(scene, 1)->face_count, cases[i].faces);
        assert_int_equal(mesh_face_size(scene_mesh(scene, 1), 0), cases[i].size);
        kiln_scene_destroy(scene);
    }
}

/* A cube whose 90° bends become creases keeps its shape; with 100° it becomes a ball. */
static void crease_angles_keep_edges(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    shape_add(f->scene, &cube, f->report);
    run(f, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 2, .crease_angle_rad = 1.2});
    assert_true(scene_mesh(f->scene, 1)->max[0] == 1 && scene_mesh(f->scene, 1)->min[2] == -1);
    shape_add(f->scene, &cube, f->report);
    run(f, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 2, .crease_angle_rad = 1.8});
    assert_true(scene_mesh(f->scene, 2)->max[0] < 0.9f);
}

static void bad_options_are_refused(void **state) {
    fixture *f = *state;
    kiln_camera camera = kiln_camera_default();
    camera.yfov_rad = NAN;
    const kiln_subdivide_options bad[] = {
        {.mode = KILN_SUBDIVIDE_LEVEL}, {.mode = KILN_SUBDIVIDE_LEVEL, .level = 7}, {.mode = (kiln_subdivide_mode)3},
        {.scheme = (kiln_scheme)5}, {.crease_angle_rad = NAN}, {.crease_angle_rad = -1},
        {.camera = &camera, .height = 5}};
    const uint32_t n = sizeof bad / sizeof *bad;
    for (uint32_t i = 0; i < n; i++) {
        assert_false(kiln_subdivide(f->scene, &bad[i], &f->rows, &f->count, f->report));
        assert_null(f->rows);
        assert_int_equal(kiln_report_count(f->report, KILN_ERROR), i + 1);
    }
    assert_true(kiln_scene_commit(f->scene, f->report));
    assert_false(kiln_subdivide(f->scene, NULL, NULL, NULL, f->report));
}

/* The same sphere, near and far: the nearer wants more levels; one that nobody shows wants one; one whose edges are
 * below a pixel none. */
static void levels_follow_the_view(void **state) {
    fixture *f = *state;
    shape sphere, exported;
    shape_quad_sphere(&sphere, 12, 1);
    shape_export(&exported, &sphere);
    const double distances[] = {3, 12, 48, 2000};
    for (uint32_t i = 0; i < 4; i++) place(f, shape_add(f->scene, &exported, f->report), 1, -distances[i]);
    place(f, 1, 1, -500); /* the nearest instance counts, */
    place(f, 4, 1e-9, -1); /* and not a speck before the eye */
    shape_add(f->scene, &sphere, f->report);
    kiln_camera camera = kiln_camera_default();
    run(f, (kiln_subdivide_options){.camera = &camera, .width = 1024, .height = 1024});
    assert_true(f->rows[0].refined && f->rows[1].refined && f->rows[2].refined);
    assert_true(f->rows[0].level > f->rows[1].level && f->rows[1].level > f->rows[2].level);
    assert_int_equal(f->rows[2].level, 1);
    assert_true(!f->rows[3].refined && !strcmp(f->rows[3].reason, "its edges are not longer than a pixel"));
    assert_true(f->rows[4].refined && f->rows[4].level == 1);
    shape_free(&sphere);
    shape_free(&exported);
}

/* The promise behind the level: the facets' middles lie within a tenth of a pixel of the sphere. */
static void facets_lie_within_a_tenth_of_a_pixel(void **state) {
    fixture *f = *state;
    shape sphere;
    shape_quad_sphere(&sphere, 4, 1);
    shape_add(f->scene, &sphere, f->report);
    place(f, 1, 1, -5);
    kiln_camera camera = kiln_camera_default();
    camera.projection = KILN_ORTHOGRAPHIC;
    camera.ymag = 1.25; /* 400 pixels a metre */
    run(f, (kiln_subdivide_options){.camera = &camera, .width = 1000, .height = 1000});
    const kiln_mesh *m = scene_mesh(f->scene, 1);
    double longest = 0, chord = 0;
    for (uint32_t c = 0; c < m->corner_count; c++) {
        uint32_t here = 3 * m->face_vertices[c], next = 3 * m->face_vertices[c % 4 == 3 ? c - 3 : c + 1];
        const float *a = m->positions + here, *b = m->positions + next;
        double length = 0, turn = 0;
        const kiln_primvar *normals = mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0);
        const float *na = normals->values + here, *nb = normals->values + next;
        for (int k = 0; k < 3; k++) {
            length += pow((double)a[k] - (double)b[k], 2);
            turn += (double)na[k] * (double)nb[k];
        }
        longest = fmax(longest, 400 * sqrt(length));
        chord = fmax(chord, 400 * sqrt(length) * acos(fmin(turn, 1)) / 8);
    }
    assert_true(chord < 0.12 || longest < 1.2);
    assert_true(chord > 0.02 && f->rows[0].level >= 2); /* and not much closer: a level more would be a quarter */
    shape_free(&sphere);
}

static void limits_lower_levels_fairly(void **state) {
    fixture *f = *state;
    shape cube, sphere;
    shape_cube(&cube);
    shape_quad_sphere(&sphere, 8, 1);
    shape_add(f->scene, &cube, f->report);
    shape_add(f->scene, &sphere, f->report);
    run(f, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 4, .triangle_limit = 20000});
    assert_int_equal(f->rows[0].level, 4); /* 3,072 triangles */
    assert_int_equal(f->rows[1].level, 2); /* 768 × 16 of at most 20,000 − 3,072 */
    assert_true(kiln_scene_count(f->scene).triangles_unique <= 20000);
    assert_int_equal(kiln_report_count(f->report, KILN_WARNING), 1);
    shape_add(f->scene, &sphere, f->report);
    run(f, (kiln_subdivide_options){.triangle_limit = 100});
    assert_true(!f->rows[2].refined && !strcmp(f->rows[2].reason, "refining it would exceed the limit of triangles"));
    assert_int_equal(scene_mesh(f->scene, 3)->face_count, sphere.desc.face_count);
    shape_free(&sphere);
}

static void threads_change_nothing(void **state) {
    (void)state;
    kiln_scene *scenes[2] = {kiln_scene_create(), kiln_scene_create()};
    kiln_report *report = kiln_report_create();
    shape sphere, cube, exported;
    shape_quad_sphere(&sphere, 8, 1);
    shape_export(&exported, &sphere);
    shape_cube(&cube);
    for (uint32_t i = 0; i < 2; i++) {
        for (int k = 0; k < 8; k++) shape_add(scenes[i], k % 3 ? &exported : &cube, report);
        kiln_subdivide_options options = {.threads = i ? 7 : 1};
        assert_true(kiln_subdivide(scenes[i], &options, NULL, NULL, report));
    }
    for (kiln_id id = 1; id <= 8; id++) {
        const kiln_mesh *a = scene_mesh(scenes[0], id), *b = scene_mesh(scenes[1], id);
        assert_int_equal(a->vertex_count, b->vertex_count);
        assert_memory_equal(a->positions, b->positions, 3 * a->vertex_count * sizeof(float));
        assert_memory_equal(a->primvars[0].values, b->primvars[0].values,
                            3 * a->primvars[0].value_count * sizeof(float));
    }
    for (int i = 0; i < 2; i++) kiln_scene_destroy(scenes[i]);
    kiln_report_destroy(report);
    shape_free(&sphere);
    shape_free(&exported);
}

/* A cube that grows by half over the shutter: every time is refined as a cube of that size would be. */
static void motion_is_refined_time_by_time(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    float times[48];
    for (int i = 0; i < 24; i++) times[i] = cube.desc.positions[i], times[24 + i] = 1.5f * cube.desc.positions[i];
    shape_add(f->scene, &cube, f->report);
    cube.desc.positions = times;
    cube.desc.time_count = 2;
    shape_add(f->scene, &cube, f->report);
    run(f, (kiln_subdivide_options){0});
    const kiln_mesh *rigid = scene_mesh(f->scene, 1), *moving = scene_mesh(f->scene, 2);
    assert_int_equal(moving->time_count, 2);
    for (uint32_t i = 0; i < 3 * rigid->vertex_count; i++) {
        assert_true(moving->positions[i] == rigid->positions[i]);
        assert_true(fabsf(moving->positions[3 * rigid->vertex_count + i] - 1.5f * rigid->positions[i]) < 1e-6f);
    }
}

/* Two materials on one sphere: it is refined as one, and the border between them stays closed. */
static void borders_between_materials_do_not_crack(void **state) {
    fixture *f = *state;
    shape sphere, exported;
    shape_quad_sphere(&sphere, 6, 1);
    shape_export(&exported, &sphere);
    kiln_material material = kiln_material_default();
    for (int i = 0; i < 2; i++) assert_true(kiln_scene_add_material(f->scene, &material, NULL, f->report));
    kiln_id *materials = arena_array(&exported.arena, exported.desc.face_count, sizeof *materials);
    for (uint32_t t = 0; t < exported.desc.face_count; t++) materials[t] = 1 + (t / 14) % 2;
    exported.desc.face_materials = materials;
    shape_add(f->scene, &exported, f->report);
    run(f, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 2});
    const kiln_mesh *m = scene_mesh(f->scene, 1);
    edge_census census = shape_edges(m);
    assert_int_equal(census.open, 0);
    assert_int_equal(census.edges, 2 * m->face_count);
    uint32_t counts[3] = {0};
    for (uint32_t face = 0; face < m->face_count; face++) counts[mesh_face_material(m, face)]++;
    assert_true(counts[0] == 0 && counts[1] > 0 && counts[2] > 0 && counts[1] + counts[2] == m->face_count);
    shape_free(&sphere);
    shape_free(&exported);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(off_and_level_are_obeyed, setup, teardown),
        cmocka_unit_test_setup_teardown(schemes_may_be_given, setup, teardown),
        cmocka_unit_test_setup_teardown(crease_angles_keep_edges, setup, teardown),
        cmocka_unit_test_setup_teardown(bad_options_are_refused, setup, teardown),
        cmocka_unit_test_setup_teardown(levels_follow_the_view, setup, teardown),
        cmocka_unit_test_setup_teardown(facets_lie_within_a_tenth_of_a_pixel, setup, teardown),
        cmocka_unit_test_setup_teardown(limits_lower_levels_fairly, setup, teardown),
        cmocka_unit_test_setup_teardown(threads_change_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(motion_is_refined_time_by_time, setup, teardown),
        cmocka_unit_test_setup_teardown(borders_between_materials_do_not_crack, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
