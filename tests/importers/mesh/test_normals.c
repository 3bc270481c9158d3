#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "importers/mesh/normals.h"
#include "importers/mesh/topology.h"

static const double pi = 3.14159265358979323846;

static void assert_near(const float *v, double x, double y, double z, double tolerance) {
    if (fabs(v[0] - x) > tolerance || fabs(v[1] - y) > tolerance || fabs(v[2] - z) > tolerance)
        fail_msg("(%g %g %g) is not (%g %g %g)", (double)v[0], (double)v[1], (double)v[2], x, y, z);
}

static void faces_point_to_their_front(void **state) {
    (void)state;
    const float positions[] = {0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0, 5, 5, 5, 1e30f, 0, 0, NAN, 0, 0};
    float n[3];
    normals_face(positions, (const uint32_t[]){0, 1, 2}, 3, n);
    assert_near(n, 0, 0, 1, 0);
    normals_face(positions, (const uint32_t[]){2, 1, 0}, 3, n);
    assert_near(n, 0, 0, -1, 0);
    normals_face(positions, (const uint32_t[]){0, 1, 2, 3}, 4, n);
    assert_near(n, 0, 0, 1, 0);
    /* A concave polygon whose fan turns over still has its own front. */
    const float arrow[] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 3, 1, 0};
    normals_face(arrow, (const uint32_t[]){2, 3, 0, 1}, 4, n);
    assert_near(n, 0, 0, 1, 0);
    /* No area, no numbers: still a unit vector. */
    normals_face(positions, (const uint32_t[]){4, 4, 4}, 3, n);
    assert_near(n, 0, 1, 0, 0);
    normals_face(positions, (const uint32_t[]){0, 1, 6}, 3, n);
    assert_near(n, 0, 1, 0, 0);
    normals_face(positions, (const uint32_t[]){0, 5, 2}, 3, n);
    assert_near(n, 0, 0, 1, 1e-6);
}

/* 12 triangles, cut along whatever diagonals come. */
static void make_cube(float *positions) {
    static const uint8_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    static const uint8_t cut[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
    for (int f = 0; f < 6; f++)
        for (int k = 0; k < 6; k++) {
            int corner = quads[f][cut[f % 2][k]];
            for (int axis = 0; axis < 3; axis++) *positions++ = corner >> axis & 1 ? 1.0f : -1.0f;
        }
}

static void cube_by_crease_angle(void **state) {
    (void)state;
    float positions[108], normals[108], flat[3];
    kiln_report *report = kiln_report_create();
    make_cube(positions);
    assert_true(normals_smooth(positions, 12, 0.5 * pi - 0.01, normals, report));
    for (uint32_t c = 0; c < 36; c++) {
        normals_face(positions, (const uint32_t[]){c / 3 * 3, c / 3 * 3 + 1, c / 3 * 3 + 2}, 3, flat);
        assert_near(normals + 3 * c, flat[0], flat[1], flat[2], 1e-7);
    }
    /* Smooth, a cube's corner points along its diagonal, however the faces are cut: that is what the angle weights
     * are for. */
    assert_true(normals_smooth(positions, 12, pi, normals, report));
    for (uint32_t c = 0; c < 36; c++) {
        const float *p = positions + 3 * c;
        assert_near(normals + 3 * c, p[0] / sqrt(3), p[1] / sqrt(3), p[2] / sqrt(3), 1e-6);
    }
    assert_int_equal(kiln_report_size(report), 0);
    kiln_report_destroy(report);
}

/* A hinge of two right angles, one leaf three times as large. */
static void large_faces_weigh_more(void **state) {
    (void)state;
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, -3};
    float normals[18];
    kiln_report *report = kiln_report_create();
    assert_true(normals_smooth(positions, 2, pi, normals, report));
    assert_near(normals, 0, -3 / sqrt(10), 1 / sqrt(10), 1e-6);
    assert_near(normals + 6, 0, 0, 1, 0);
    kiln_report_destroy(report);
}

static float *make_sphere(uint32_t rings, uint32_t sides, double scale, double offset) {
    float *positions = calloc((size_t)rings * sides * 18, sizeof *positions), *to = positions;
    for (uint32_t i = 0; i < rings; i++)
        for (uint32_t j = 0; j < sides; j++) {
            const uint32_t at[6][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j}, {i + 1, j + 1}, {i, j + 1}};
            for (int k = 0; k < 6; k++) {
                /* The poles are exact: each polar quad has a triangle without extent. */
                double a = pi * at[k][0] / rings, b = 2 * pi * (at[k][1] % sides) / sides;
                double r = at[k][0] == 0 || at[k][0] == rings ? 0 : sin(a);
                *to++ = (float)(offset + scale * r * cos(b));
                *to++ = (float)(scale * cos(a));
                *to++ = (float)(-scale * r * sin(b));
            }
        }
    return positions;
}

static void sphere_is_radial(void **state) {
    (void)state;
    const uint32_t rings = 32, sides = 64, count = 2 * rings * sides;
    const double scales[] = {1e-6, 1, 1e6, 1e30};
    kiln_report *report = kiln_report_create();
    float *normals = calloc(9 * count, sizeof *normals);
    for (size_t s = 0; s < sizeof scales / sizeof *scales; s++) {
        float *p = make_sphere(rings, sides, scales[s], 0);
        assert_true(normals_smooth(p, count, 0.5, normals, report));
        for (uint32_t c = 0; c < 3 * count; c++) {
            uint32_t t = c / 3 * 3;
            dvec3 a = corner_vector(p, t), b = corner_vector(p, t + 1), d = corner_vector(p, t + 2);
            if (d3_length(d3_cross(d3_sub(b, a), d3_sub(d, a))) == 0) continue;
            dvec3 n = corner_vector(normals, c), radial = d3_normalize(corner_vector(p, c));
            assert_true(corner_angle(n, radial) < 0.5 * pi / 180);
        }
        free(p);
    }
    free(normals);
    kiln_report_destroy(report);
}

static void any_input_gives_unit_normals(void **state) {
    (void)state;
    const float evil[] = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e-45f, 0, 1};
    enum { COUNT = 4096 };
    float *positions = calloc(9 * COUNT, sizeof *positions), *normals = calloc(9 * COUNT, sizeof *normals);
    uint32_t random = 1;
    for (size_t i = 0; i < 9 * COUNT; i++) {
        random = random * 1664525u + 1013904223u;
        positions[i] = evil[random >> 29];
    }
    kiln_report *report = kiln_report_create();
    assert_true(normals_smooth(positions, COUNT, 1, normals, report));
    for (uint32_t c = 0; c < 3 * COUNT; c++) assert_true(fabs(d3_length(corner_vector(normals, c)) - 1) < 1e-6);
    assert_true(normals_smooth(NULL, 0, 1, NULL, report));
    assert_false(normals_smooth(positions, UINT32_MAX / 3, 1, normals, report));
    assert_int_equal(kiln_report_message(report, 0).code, KILN_CODE_LIMIT);
    kiln_report_destroy(report);
    free(positions);
    free(normals);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_point_to_their_front),
        cmocka_unit_test(cube_by_crease_angle),
        cmocka_unit_test(large_faces_weigh_more),
        cmocka_unit_test(sphere_is_radial),
        cmocka_unit_test(any_input_gives_unit_normals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
