/* Limit normals: against the sphere, on both sides of creases, against the facets of deep refinements. */
#include "tests/importers/subdiv/obj.h"
#include "tests/importers/subdiv/support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "importers/subdiv/osd.h"
#include "tests/assets.h"

static osd_surface refine(fixture *f, const shape *s, uint32_t level) {
    kiln_cage cage;
    osd_surface surface;
    char obstacle[160];
    kiln_id id = shape_add(f->scene, s, f->report);
    assert_true(cage_build(scene_mesh(f->scene, id), &(cage_options){0}, &f->arena, &cage, obstacle, NULL, f->report));
    assert_true(osd_refine(&cage, level, &f->arena, &surface, NULL, f->report));
    return surface;
}

static dvec3 load(const float *p) { return (dvec3){p[0], p[1], p[2]}; }
static double angle(dvec3 a, dvec3 b) { return atan2(d3_length(d3_cross(a, b)), d3_dot(a, b)) * 57.29577951308232; }
static dvec3 point(const osd_surface *s, uint32_t corner) {
    return load(s->positions + 3 * (size_t)s->face_vertices[corner]);
}
static uint32_t normal_index(const osd_surface *s, uint32_t corner) {
    return s->normals.indices ? s->normals.indices[corner] : s->face_vertices[corner];
}
static dvec3 normal(const osd_surface *s, uint32_t corner) {
    return load(s->normals.values + 3 * (size_t)normal_index(s, corner));
}

typedef struct error { double rms, max; } error;

static error sphere_error(fixture *f, const shape *s, uint32_t level) {
    osd_surface surface = refine(f, s, level);
    error e = {0};
    assert_null(surface.normals.indices); /* smooth everywhere: one normal per vertex */
    for (uint32_t v = 0; v < surface.vertex_count; v++) {
        double a = angle(load(surface.positions + 3 * (size_t)v), load(surface.normals.values + 3 * (size_t)v));
        e.rms += a * a / surface.vertex_count;
        e.max = fmax(e.max, a);
    }
    e.rms = sqrt(e.rms);
    return e;
}

static void spheres_have_radial_normals(void **state) {
    fixture *f = *state;
    shape quads, triangles;
    shape_quad_sphere(&quads, 8, 1);
    shape_icosphere(&triangles, 2);
    for (uint32_t level = 1; level <= 3; level++) {
        error q = sphere_error(f, &quads, level), t = sphere_error(f, &triangles, level);
        assert_true(q.rms < 0.3 && q.max < 0.6); /* measured 0.23 and 0.43 degrees */
        assert_true(t.rms < 0.6 && t.max < 1.0); /* 0.53 and 0.93: the cage is coarser */
    }
    shape_free(&quads);
    shape_free(&triangles);
}

/* A cube whose edges are all infinitely sharp stays a cube: 3 normals at a corner, 2 at an edge, 1 elsewhere. */
static void sharp_edges_split_normals(void **state) {
    fixture *f = *state;
    const uint32_t creases[24] = {0, 1, 1, 3, 3, 2, 2, 0, 3, 5, 5, 4, 4, 2, 5, 7, 7, 6, 6, 4, 7, 1, 0, 6};
    float sharpness[12];
    for (int i = 0; i < 12; i++) sharpness[i] = 10;
    shape s;
    shape_cube(&s);
    s.desc.subdivision.crease_vertices = creases;
    s.desc.subdivision.crease_sharpness = sharpness;
    s.desc.subdivision.crease_count = 12;
    osd_surface surface = refine(f, &s, 2);
    assert_int_equal(surface.vertex_count, 98);
    assert_int_equal(surface.normals.value_count, 8 * 3 + 12 * 3 * 2 + 6 * 9);
    for (uint32_t c = 0; c < 4 * surface.face_count; c++) {
        uint32_t first = c / 4 * 4;
        dvec3 facet = d3_cross(d3_sub(point(&surface, first + 1), point(&surface, first)),
                               d3_sub(point(&surface, first + 2), point(&surface, first)));
        assert_true(angle(facet, normal(&surface, c)) < 1e-4);
    }
}

/* One closed ring of creases around a cube's face: a flat lid beside a round bowl. */
static void a_crease_has_two_sides(void **state) {
    fixture *f = *state;
    const uint32_t creases[8] = {0, 1, 1, 3, 3, 2, 2, 0};
    const float sharpness[4] = {10, 10, 10, 10};
    shape s;
    shape_cube(&s);
    s.desc.subdivision.crease_vertices = creases;
    s.desc.subdivision.crease_sharpness = sharpness;
    s.desc.subdivision.crease_count = 4;
    osd_surface surface = refine(f, &s, 3);
    uint32_t split = 0;
    for (uint32_t c = 0; c < 4 * surface.face_count; c++) {
        bool lid = surface.face_parents[c / 4] == 0;
        if (lid) assert_true(angle(normal(&surface, c), (dvec3){0, 0, 1}) < 1e-3);
        if (lid || fabs(point(&surface, c).z - 1) > 1e-6) continue;
        assert_true(angle(normal(&surface, c), (dvec3){0, 0, 1}) > 30);
        split++;
    }
    assert_true(split > 0);
}

/* A dart is where a crease ends in the middle of a smooth surface: one normal, on all its faces. */
static void a_dart_is_smooth(void **state) {
    fixture *f = *state;
    const uint32_t crease[2] = {0, 1};
    const float sharpness[1] = {10};
    shape s;
    shape_cube(&s);
    s.desc.subdivision.crease_vertices = crease;
    s.desc.subdivision.crease_sharpness = sharpness;
    s.desc.subdivision.crease_count = 1;
    osd_surface surface = refine(f, &s, 2);
    assert_int_equal(surface.normals.value_count, surface.vertex_count + 3); /* the three points inside the edge */
    uint32_t at_dart = UINT32_MAX;
    for (uint32_t c = 0; c < 24; c++) {
        if (s.desc.face_vertices[c] != 0) continue;
        uint32_t n = normal_index(&surface, surface.cage_corners[c]);
        assert_true(at_dart == UINT32_MAX || n == at_dart);
        at_dart = n;
    }
}

/* Facets of a deep refinement turn little from corner to corner, so a normal of the wrong side stands out. */
static double share_off_facets(const osd_surface *s, double degrees) {
    uint32_t n = s->face_size, off = 0;
    for (uint32_t c = 0; c < n * s->face_count; c++) {
        uint32_t first = c / n * n;
        dvec3 here = point(s, c), next = point(s, first + (c + 1) % n), before = point(s, first + (c + n - 1) % n);
        off += angle(d3_cross(d3_sub(next, here), d3_sub(before, here)), normal(s, c)) > degrees;
    }
    return (double)off / (n * s->face_count);
}

static void shapes_have_the_normals_of_their_facets(void **state) {
    fixture *f = *state;
    char folder[8192], path[16384];
    snprintf(folder, sizeof folder, "%s/subdiv", assets_or_skip());
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *e; (e = readdir(directory)) != NULL;) {
        if (!strstr(e->d_name, ".obj")) continue;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        shape s;
        assert_true(obj_read(path, &s));
        if (s.desc.subdivision.scheme == KILN_SCHEME_BILINEAR || s.desc.face_count > 12) {
            shape_free(&s);
            continue;
        }
        osd_surface surface = refine(f, &s, 6);
        double off = share_off_facets(&surface, 20);
        if (off > 0.01)
            fail_msg("%s: %.1f %% of the normals are more than 20 degrees off their facets", e->d_name, 100 * off);
        shape_free(&s);
        arena_free(&f->arena);
    }
    closedir(directory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(spheres_have_radial_normals, setup, teardown),
        cmocka_unit_test_setup_teardown(sharp_edges_split_normals, setup, teardown),
        cmocka_unit_test_setup_teardown(a_crease_has_two_sides, setup, teardown),
        cmocka_unit_test_setup_teardown(a_dart_is_smooth, setup, teardown),
        cmocka_unit_test_setup_teardown(shapes_have_the_normals_of_their_facets, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
