/* What `auto` does with meshes that say nothing about subdivision. */
#include "tests/importers/subdiv/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kiln/import.h"

/* The row that `auto` gives for an exported shape; the mesh is number f->scene->mesh_count then. */
static kiln_subdivision_result look(fixture *f, const shape *s) {
    shape exported;
    shape_export(&exported, s);
    kiln_subdivision_result *rows, row;
    uint32_t count;
    kiln_id id = shape_add(f->scene, &exported, f->report);
    assert_true(kiln_subdivide(f->scene, &(kiln_subdivide_options){.threads = 1}, &rows, &count, f->report));
    assert_int_equal(count, id);
    row = rows[id - 1];
    assert_int_equal(row.mesh, id);
    if (!row.refined) assert_int_equal(scene_mesh(f->scene, id)->face_count, exported.desc.face_count);
    assert_true(row.reason[0] != '\0' && memchr(row.reason, 0, sizeof row.reason));
    free(rows);
    shape_free(&exported);
    return row;
}

static void assert_left_alone(kiln_subdivision_result row, const char *reason) {
    if (row.refined || !strstr(row.reason, reason))
        fail_msg("refined %d: %s (expected: %s)", row.refined, row.reason, reason);
}

static void smooth_spheres_are_refined_in_place(void **state) {
    fixture *f = *state;
    shape quads, triangles;
    shape_quad_sphere(&quads, 12, 3);
    shape_icosphere(&triangles, 3);
    kiln_subdivision_result row = look(f, &quads);
    assert_true(row.refined && row.level == 2 && row.scheme == KILN_SCHEME_CATMULL_CLARK && row.quad_rate == 1);
    assert_true(!strncmp(row.reason, "smooth: authored normals agree with the limit within 0.", 54));
    const kiln_mesh *m = scene_mesh(f->scene, row.mesh);
    assert_int_equal(m->face_count, quads.desc.face_count * 16);
    for (uint32_t v = 0; v < m->vertex_count; v++) { /* as large as before: plain refinement shrinks it by 0.5 % */
        const float *p = m->positions + 3 * v;
        double radius = sqrt((double)p[0] * p[0] + (double)p[1] * p[1] + (double)p[2] * p[2]);
        assert_true(fabs(radius / 3 - 1) < 0.001);
    }
    row = look(f, &triangles);
    assert_true(row.refined && row.scheme == KILN_SCHEME_LOOP && row.quad_rate < 0.7);
    assert_int_equal(kiln_report_size(f->report), 0);
    shape_free(&quads);
    shape_free(&triangles);
}

static void products_are_left_alone(void **state) {
    fixture *f = *state;
    shape cube, box, cylinder, strip, coarse;
    shape_cube(&cube);
    assert_left_alone(look(f, &cube), "no authored normals");

    box = cube;
    float normals[72], smooth[24];
    static const float facets[6][3] = {{0, 0, 1}, {0, 1, 0}, {0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}};
    for (int c = 0; c < 24; c++) memcpy(normals + 3 * c, facets[c / 4], 3 * sizeof(float));
    box.primvars[0] = (kiln_primvar){KILN_PRIMVAR_NORMAL, 0, KILN_FACE_VARYING, normals, 24, NULL};
    box.desc.primvars = box.primvars;
    box.desc.primvar_count = 1;
    assert_left_alone(look(f, &box), "flat or hard edges");

    memcpy(smooth, cube.desc.positions, sizeof smooth); /* averaged normals on a box: it is still no ball */
    box.primvars[0] = (kiln_primvar){KILN_PRIMVAR_NORMAL, 0, KILN_VERTEX, smooth, 8, NULL};
    assert_left_alone(look(f, &box), "too coarse to tell");

    shape_cylinder(&cylinder, 64);
    assert_left_alone(look(f, &cylinder), "flat or hard edges");

    shape_strip(&strip, 8, 3); /* a flat sheet gains nothing */
    float up[54] = {0};
    for (int v = 0; v < 18; v++) up[3 * v + 2] = 1;
    strip.primvars[1] = (kiln_primvar){KILN_PRIMVAR_NORMAL, 0, KILN_VERTEX, up, 18, NULL};
    strip.desc.primvar_count = 2;
    assert_left_alone(look(f, &strip), "flat: there is nothing to round off");

    shape_quad_sphere(&coarse, 12, 1); /* normals of something else */
    float *tilted = (float *)coarse.primvars[0].values;
    for (uint32_t v = 0; v < coarse.desc.vertex_count; v++) tilted[3 * v] += .2f; /* by up to 11° */
    assert_left_alone(look(f, &coarse), "authored normals are up to");
    shape_free(&cylinder);
    shape_free(&strip);
    shape_free(&coarse);
}

/* A flat ring of 24 sides: its surface is no rounder than it is, but its outline would be. */
static void outlines_count(void **state) {
    fixture *f = *state;
    enum { N = 24 };
    float positions[6 * N], normals[6 * N] = {0};
    uint32_t sizes[N], corners[4 * N];
    for (uint32_t i = 0; i < N; i++) {
        float x = cosf((float)i * 6.2831853f / N), y = sinf((float)i * 6.2831853f / N);
        const float two[6] = {x, y, 0, 2 * x, 2 * y, 0};
        const uint32_t next = (i + 1) % N, face[4] = {2 * i, 2 * i + 1, 2 * next + 1, 2 * next};
        memcpy(positions + 6 * i, two, sizeof two);
        memcpy(corners + 4 * i, face, sizeof face);
        normals[6 * i + 2] = normals[6 * i + 5] = 1;
        sizes[i] = 4;
    }
    shape ring = {.desc = {.vertex_count = 2 * N, .positions = positions, .face_count = N, .face_sizes = sizes,
                           .face_vertices = corners}};
    ring.primvars[0] = (kiln_primvar){KILN_PRIMVAR_NORMAL, 0, KILN_VERTEX, normals, 2 * N, NULL};
    ring.desc.primvars = ring.primvars;
    ring.desc.primvar_count = 1;
    assert_left_alone(look(f, &ring), "refining would deform it");
}

/* Normals of length zero say that the face's own is meant. */
static void missing_normals_are_hard_edges(void **state) {
    fixture *f = *state;
    shape sphere;
    shape_quad_sphere(&sphere, 8, 1);
    memset((float *)sphere.primvars[0].values, 0, 3 * sphere.desc.vertex_count * sizeof(float));
    assert_left_alone(look(f, &sphere), "normals are split at 100 %");
    shape_free(&sphere);
}

/* A scheme for all meshes settles nothing about those that ask for none; bilinear facets stay what they are. */
static void a_given_scheme_is_tried_alone(void **state) {
    fixture *f = *state;
    shape sphere, exported;
    shape_quad_sphere(&sphere, 12, 1);
    shape_export(&exported, &sphere);
    for (int scheme = KILN_SCHEME_CATMULL_CLARK; scheme <= KILN_SCHEME_BILINEAR; scheme++) {
        kiln_id id = shape_add(f->scene, &exported, f->report);
        kiln_subdivision_result *rows;
        uint32_t count;
        kiln_subdivide_options options = {.scheme = (kiln_scheme)scheme};
        assert_true(kiln_subdivide(f->scene, &options, &rows, &count, f->report));
        assert_true(rows[id - 1].refined == (scheme != KILN_SCHEME_BILINEAR));
        assert_int_equal(rows[id - 1].scheme, scheme);
        free(rows);
    }
    shape_free(&sphere);
    shape_free(&exported);
}

static void numbers_without_measure_are_left_alone(void **state) {
    fixture *f = *state;
    shape sphere;
    shape_quad_sphere(&sphere, 8, 3.402e38f); /* fitting it would leave what a float can hold */
    kiln_subdivision_result row = look(f, &sphere);
    assert_false(row.refined);
    shape_free(&sphere);
}

static void who_says_something_is_obeyed(void **state) {
    fixture *f = *state;
    shape cube, exported;
    shape_cube(&cube);
    shape_export(&exported, &cube);
    kiln_subdivision_result *rows;
    uint32_t count;
    struct { kiln_scheme scheme; int32_t level; bool refined; uint32_t expected; } cases[] = {
        {KILN_SCHEME_NONE, 0, false, 0}, {KILN_SCHEME_AUTO, 0, false, 0}, {KILN_SCHEME_AUTO, 3, true, 3},
        {KILN_SCHEME_CATMULL_CLARK, 0, true, 2}, {KILN_SCHEME_LOOP, 1, true, 1}, {KILN_SCHEME_BILINEAR, 99, true, 6}};
    const uint32_t n = sizeof cases / sizeof *cases;
    for (uint32_t i = 0; i < n; i++) {
        exported.desc.subdivision.scheme = cases[i].scheme;
        exported.desc.subdivision.level = cases[i].level;
        shape_add(f->scene, &exported, f->report);
    }
    assert_true(kiln_subdivide(f->scene, NULL, &rows, &count, f->report));
    assert_int_equal(count, n);
    for (uint32_t i = 0; i < n; i++) {
        assert_true(rows[i].refined == cases[i].refined);
        assert_int_equal(rows[i].level, cases[i].expected);
    }
    assert_int_equal(rows[2].scheme, KILN_SCHEME_CATMULL_CLARK); /* it was quads, and so it is refined */
    assert_int_equal(scene_mesh(f->scene, 3)->face_count, 6 * 64);
    assert_int_equal(scene_mesh(f->scene, 5)->face_count, 12 * 4);
    free(rows);
    shape_free(&exported);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(smooth_spheres_are_refined_in_place, setup, teardown),
        cmocka_unit_test_setup_teardown(products_are_left_alone, setup, teardown),
        cmocka_unit_test_setup_teardown(outlines_count, setup, teardown),
        cmocka_unit_test_setup_teardown(missing_normals_are_hard_edges, setup, teardown),
        cmocka_unit_test_setup_teardown(a_given_scheme_is_tried_alone, setup, teardown),
        cmocka_unit_test_setup_teardown(numbers_without_measure_are_left_alone, setup, teardown),
        cmocka_unit_test_setup_teardown(who_says_something_is_obeyed, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
