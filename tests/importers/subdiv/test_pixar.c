/* Pixar's regression shapes: creases, corners, holes, face-varying values, boundaries, odd valences and polygons. */
#include "tests/importers/subdiv/obj.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kiln/import.h"
#include "tests/assets.h"
#include "tests/importers/subdiv/reference.h"

static double diagonal_of(const kiln_mesh_desc *d) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < d->vertex_count; v++) {
            low = fmin(low, (double)d->positions[3 * v + (uint32_t)k]);
            high = fmax(high, (double)d->positions[3 * v + (uint32_t)k]);
        }
        sum += (high - low) * (high - low);
    }
    return sqrt(sum);
}

typedef struct worst {
    double position, uv, normal; /* relative to the bounds; to 1; radians */
    uint32_t compared_normals;
} worst;

static void compare_corner(const kiln_mesh *m, uint32_t corner, const reference *r, worst *w) {
    uint32_t v = m->face_vertices[corner], face = corner / mesh_face_size(m, 0);
    double distance = 0;
    for (uint32_t k = 0; k < 3; k++)
        distance = fmax(distance, fabs((double)m->positions[3 * v + k] - (double)r->positions[3 * corner + k]));
    w->position = fmax(w->position, distance);
    const kiln_primvar *uvs = mesh_primvar(m, KILN_PRIMVAR_UV, 0), *normals = mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0);
    for (uint32_t k = 0; r->uvs && k < 2; k++)
        w->uv = fmax(w->uv, fabs((double)primvar_at(uvs, face, corner, v)[k] - (double)r->uvs[2 * corner + k]));
    const float *expected = r->normals + 3 * (size_t)corner, *n = primvar_at(normals, face, corner, v);
    dvec3 a = {expected[0], expected[1], expected[2]}, b = {n[0], n[1], n[2]};
    if (d3_length(a) == 0) return;
    w->normal = fmax(w->normal, atan2(d3_length(d3_cross(a, b)), d3_dot(a, b)));
    w->compared_normals++;
}

static worst check_shape(const shape *s, uint32_t level) {
    kiln_scene *scene = kiln_scene_create();
    kiln_report *report = kiln_report_create();
    reference r;
    worst w = {0};
    shape_add(scene, s, report);
    kiln_subdivide_options options = {.mode = KILN_SUBDIVIDE_LEVEL, .level = level, .threads = 1};
    kiln_subdivision_result *rows;
    uint32_t count;
    assert_true(kiln_subdivide(scene, &options, &rows, &count, report));
    assert_true(rows[0].refined && rows[0].level == level && rows[0].scheme == s->desc.subdivision.scheme);
    assert_true(reference_refine(&s->desc, (int)level, &r));
    const kiln_mesh *m = scene_mesh(scene, 1);
    assert_int_equal(m->corner_count, r.corner_count);
    for (uint32_t c = 0; c < m->corner_count; c++) compare_corner(m, c, &r, &w);
    w.position /= diagonal_of(&s->desc);
    reference_free(&r);
    free(rows);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    return w;
}

static void a_cube_agrees_with_opensubdiv(void **state) {
    (void)state;
    const uint32_t creases[4] = {0, 1, 1, 3};
    const float sharpness[2] = {2.5f, 10};
    shape s;
    shape_cube(&s);
    s.desc.subdivision.crease_vertices = creases;
    s.desc.subdivision.crease_sharpness = sharpness;
    s.desc.subdivision.crease_count = 2;
    for (uint32_t level = 1; level <= 4; level++) {
        worst w = check_shape(&s, level);
        assert_true(w.position < 1e-6 && w.normal < 1e-4);
    }
}

static void all_shapes_agree_with_opensubdiv(void **state) {
    (void)state;
    char folder[8192], path[16384];
    snprintf(folder, sizeof folder, "%s/subdiv", assets_or_skip());
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    uint32_t count = 0;
    for (struct dirent *e; (e = readdir(directory)) != NULL;) {
        if (!strstr(e->d_name, ".obj")) continue;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        shape s;
        assert_true(obj_read(path, &s));
        worst w = check_shape(&s, 3);
        bool bilinear = s.desc.subdivision.scheme == KILN_SCHEME_BILINEAR; /* facets: no limit normals */
        /* normals: 0.1°, what the rounding of floats costs in the finest folds of the chess pieces */
        if (w.position > 1e-5 || w.uv > 1e-5 || (w.normal > 2e-3 && !bilinear))
            fail_msg("%s: positions %g of the bounds, UVs %g, normals %g rad", e->d_name, w.position, w.uv, w.normal);
        shape_free(&s);
        count++;
    }
    closedir(directory);
    assert_true(count >= 39);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_cube_agrees_with_opensubdiv),
                                       cmocka_unit_test(all_shapes_agree_with_opensubdiv)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
