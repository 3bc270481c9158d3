/* Inputs that crash OpenSubdiv, or make it read out of bounds, when it is asked directly. */
#include "tests/importers/subdiv/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kiln/import.h"

static void assert_finite(const kiln_mesh *m) {
    for (uint32_t i = 0; i < 3 * m->vertex_count * m->time_count; i++) assert_true(isfinite(m->positions[i]));
    for (uint32_t p = 0; p < m->primvar_count; p++)
        for (uint32_t i = 0; i < primvar_width(m->primvars[p].kind) * m->primvars[p].value_count; i++)
            assert_true(isfinite(m->primvars[p].values[i]));
}

/* Adds the mesh, refines it by the command, checks what came out. Returns the row. */
static kiln_subdivision_result force(fixture *f, const kiln_mesh_desc *desc, uint32_t level) {
    kiln_id id;
    kiln_subdivision_result *rows, row;
    uint32_t count;
    assert_true(kiln_scene_add_mesh(f->scene, desc, &id, f->report));
    kiln_subdivide_options options = {.mode = KILN_SUBDIVIDE_LEVEL, .level = level, .threads = 1};
    assert_true(kiln_subdivide(f->scene, &options, &rows, &count, f->report));
    row = rows[id - 1];
    free(rows);
    assert_finite(scene_mesh(f->scene, id));
    /* what was refined is polygons now: leave it alone while the next one is tried */
    kiln_scene_destroy(f->scene);
    f->scene = kiln_scene_create();
    return row;
}

/* Positions on a spiral: no two alike, none in a line. */
static float *spiral(uint32_t count) {
    float *p = calloc(count, 3 * sizeof *p);
    assert_non_null(p);
    for (uint32_t i = 0; i < count; i++)
        p[3 * i] = cosf((float)i), p[3 * i + 1] = sinf((float)i), p[3 * i + 2] = (float)i / (float)count;
    return p;
}

static void broken_topology_is_survived(void **state) {
    fixture *f = *state;
    static const struct {
        const char *what;
        uint32_t sizes[4], corners[16], faces;
    } cases[] = {
        {"isolated vertices", {4}, {0, 1, 2, 3}, 1},
        {"a point repeats", {4, 4}, {0, 1, 1, 2, 2, 1, 3, 4}, 2},
        {"a face of one point", {3}, {5, 5, 5}, 1},
        {"a bow tie", {6}, {0, 1, 2, 0, 3, 4}, 1},
        {"the same face twice", {4, 4}, {0, 1, 2, 3, 0, 1, 2, 3}, 2},
        {"a face and its back", {4, 4}, {0, 1, 2, 3, 3, 2, 1, 0}, 2},
        {"a flipped neighbour", {4, 4}, {0, 1, 2, 3, 1, 2, 5, 4}, 2},
        {"three on an edge", {3, 3, 3}, {0, 1, 2, 1, 0, 3, 0, 1, 4}, 3},
        {"four on an edge", {4, 4, 4, 4}, {0, 1, 2, 3, 1, 0, 4, 5, 0, 1, 6, 7, 1, 0, 7, 5}, 4},
        {"two that touch at a point", {4, 4}, {0, 1, 2, 3, 0, 4, 5, 6}, 2},
    };
    float *p = spiral(10);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int scheme = KILN_SCHEME_NONE; scheme <= KILN_SCHEME_AUTO; scheme++) {
            kiln_mesh_desc desc = {.name = cases[i].what, .vertex_count = 10, .positions = p,
                                   .face_count = cases[i].faces,
                                   .face_sizes = cases[i].sizes, .face_vertices = cases[i].corners,
                                   .subdivision = {.scheme = (kiln_scheme)scheme,
                                                   .triangulated = scheme == KILN_SCHEME_AUTO}};
            for (int boundary = 0; boundary <= KILN_BOUNDARY_NONE; boundary++) {
                desc.subdivision.boundary = (kiln_boundary)boundary;
                force(f, &desc, 3);
            }
        }
    free(p);
}

static void nothing_is_refined_into_nothing(void **state) {
    fixture *f = *state;
    kiln_mesh_desc desc = {.subdivision.scheme = KILN_SCHEME_CATMULL_CLARK};
    kiln_subdivision_result row = force(f, &desc, 1);
    assert_true(!row.refined && !strcmp(row.reason, "it has no faces"));
    const float p[9] = {0};
    const uint32_t corners[3] = {0, 1, 2};
    desc = (kiln_mesh_desc){.vertex_count = 3, .positions = p, .face_count = 1, .face_vertices = corners,
                            .subdivision = {.scheme = KILN_SCHEME_AUTO, .triangulated = true}};
    row = force(f, &desc, 1); /* welded to one point: no face is left */
    assert_true(!row.refined && !strcmp(row.reason, "it has no faces"));
    desc.subdivision = (kiln_subdivision){.scheme = KILN_SCHEME_LOOP};
    assert_true(force(f, &desc, 2).refined);
}

/* One polygon of n corners; a fan of n triangles around one point. */
static void large_valences_have_a_limit(void **state) {
    fixture *f = *state;
    enum { N = 70000 };
    float *p = spiral(N + 1);
    uint32_t *corners = calloc(3 * N, sizeof *corners), *sizes = calloc(N, sizeof *sizes);
    const uint32_t counts[] = {4096, 4097, N};
    for (int i = 0; i < 3; i++) {
        uint32_t n = counts[i];
        for (uint32_t k = 0; k < n; k++) corners[k] = k, sizes[k] = 3;
        kiln_mesh_desc desc = {.vertex_count = N + 1, .positions = p, .face_count = 1, .face_sizes = &n,
                               .face_vertices = corners,
                               .subdivision.scheme = KILN_SCHEME_CATMULL_CLARK};
        kiln_subdivision_result row = force(f, &desc, 1);
        assert_true(row.refined == (n <= 4096));
        if (!row.refined) assert_non_null(strstr(row.reason, "corners (at most 4096)"));
        for (uint32_t k = 0; k < n; k++) corners[3 * k] = N, corners[3 * k + 1] = k, corners[3 * k + 2] = (k + 1) % n;
        desc.face_count = n;
        desc.face_sizes = sizes;
        row = force(f, &desc, 1);
        assert_true(row.refined == (n <= 4096));
        if (!row.refined) assert_string_equal(row.reason, "vertex 70000 belongs to more than 4096 faces");
    }
    assert_int_equal(kiln_report_count(f->report, KILN_WARNING), 4);
    assert_int_equal(kiln_report_count(f->report, KILN_ERROR), 0);
    free(p);
    free(corners);
    free(sizes);
}

static void tags_of_nothing_are_left_out(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    const uint32_t creases[10] = {0, 3, 0, 99, 1, 1, 0, 1, 1, 0}, corners[3] = {8, 0, 0}, holes[3] = {77, 2, 2};
    const float crease_sharpness[5] = {2, 2, 2, NAN, 1e9f}, corner_sharpness[3] = {1, -2, 1e30f};
    cube.desc.subdivision.crease_vertices = creases;
    cube.desc.subdivision.crease_sharpness = crease_sharpness;
    cube.desc.subdivision.crease_count = 5;
    cube.desc.subdivision.corner_vertices = corners;
    cube.desc.subdivision.corner_sharpness = corner_sharpness;
    cube.desc.subdivision.corner_count = 3;
    cube.desc.subdivision.holes = holes;
    cube.desc.subdivision.hole_count = 3;
    kiln_id id;
    assert_true(kiln_scene_add_mesh(f->scene, &cube.desc, &id, f->report));
    assert_true(kiln_subdivide(f->scene, &(kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 1}, NULL,
                               NULL, f->report));
    assert_int_equal(scene_mesh(f->scene, id)->face_count, 5 * 4); /* without the hole */
    assert_finite(scene_mesh(f->scene, id));
    bool found = false;
    for (size_t i = 0; i < kiln_report_size(f->report); i++)
        found |= !strcmp(kiln_report_message(f->report, i).what, "2 creases follow no edge of the mesh: left out");
    assert_true(found);
}

static void all_holes_are_an_empty_mesh(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    const uint32_t holes[6] = {0, 1, 2, 3, 4, 5};
    cube.desc.subdivision.holes = holes;
    cube.desc.subdivision.hole_count = 6;
    assert_true(force(f, &cube.desc, 2).refined);
}

static void huge_and_tiny_coordinates_stay_finite(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    const float scales[] = {1e-42f, 1e-30f, 1e30f, 3e37f};
    for (int i = 0; i < 4; i++) {
        float p[24];
        for (int k = 0; k < 24; k++) p[k] = cube.desc.positions[k] * scales[i];
        kiln_mesh_desc desc = cube.desc;
        desc.positions = p;
        force(f, &desc, 2);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(broken_topology_is_survived, setup, teardown),
        cmocka_unit_test_setup_teardown(nothing_is_refined_into_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(large_valences_have_a_limit, setup, teardown),
        cmocka_unit_test_setup_teardown(tags_of_nothing_are_left_out, setup, teardown),
        cmocka_unit_test_setup_teardown(all_holes_are_an_empty_mesh, setup, teardown),
        cmocka_unit_test_setup_teardown(huge_and_tiny_coordinates_stay_finite, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
