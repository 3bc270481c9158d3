#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/file.h"
#include "importers/mesh/tangents.h"

typedef struct dump {
    uint32_t corner_count;
    float *positions, *normals, *uvs, *expected, *tangents;
} dump;

/* The format is described in tools/dump_tangents.py. */
static dump read_dump(const char *path, kiln_report *report) {
    kiln_bytes bytes;
    assert_true(file_read(path, 1 << 24, &bytes, NULL, report));
    uint32_t rows, corners;
    memcpy(&rows, bytes.data, 4);
    memcpy(&corners, bytes.data + 4, 4);
    assert_int_equal(bytes.size, 8 + 48 * (size_t)rows + 2 * (size_t)corners);
    dump d = {corners, calloc(corners, 12), calloc(corners, 12), calloc(corners, 8), calloc(corners, 16),
              calloc(corners, 16)};
    for (uint32_t c = 0; c < corners; c++) {
        uint16_t row;
        memcpy(&row, bytes.data + 8 + 48 * (size_t)rows + 2 * (size_t)c, 2);
        const unsigned char *at = bytes.data + 8 + 48 * (size_t)row;
        memcpy(d.positions + 3 * c, at, 12);
        memcpy(d.normals + 3 * c, at + 12, 12);
        memcpy(d.uvs + 2 * c, at + 24, 8);
        memcpy(d.expected + 4 * c, at + 32, 16);
    }
    file_free(&bytes);
    return d;
}

static void free_dump(dump *d) {
    free(d->positions);
    free(d->normals);
    free(d->uvs);
    free(d->expected);
    free(d->tangents);
}

/* Where MikkTSpace finds nothing it says (1, 0, 0), sign −1: a triangle whose three uvs are one point. */
static bool unknown(const dump *d, uint32_t corner) {
    const float *uv = d->uvs + 6 * (size_t)(corner / 3), *t = d->expected + 4 * (size_t)corner;
    return memcmp(uv, uv + 2, 8) == 0 && memcmp(uv, uv + 4, 8) == 0 && t[0] == 1 && t[3] == -1;
}

static void assert_orthonormal(const dump *d, uint32_t corner) {
    const float *t = d->tangents + 4 * (size_t)corner, *n = d->normals + 3 * (size_t)corner;
    assert_true(fabsf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - 1) < 1e-5f);
    assert_true(fabsf(t[0] * n[0] + t[1] * n[1] + t[2] * n[2]) < 1e-4f);
}

static void agree_with_blender(const char *path, double tolerance, uint32_t mirrored, uint32_t unknowns) {
    kiln_report *report = kiln_report_create();
    dump d = read_dump(path, report);
    assert_true(tangents_generate(d.positions, d.normals, d.uvs, d.corner_count / 3, d.tangents, report));
    for (uint32_t c = 0; c < d.corner_count; c++) {
        const float *t = d.tangents + 4 * (size_t)c, *e = d.expected + 4 * (size_t)c;
        assert_orthonormal(&d, c);
        if (unknown(&d, c)) {
            unknowns--;
            continue;
        }
        mirrored -= e[3] < 0;
        for (int k = 0; k < 4; k++)
            if (fabs((double)t[k] - (double)e[k]) > tolerance)
                fail_msg("corner %u: (%g %g %g %g) is not Blender's (%g %g %g %g)", c, (double)t[0], (double)t[1],
                         (double)t[2], (double)t[3], (double)e[0], (double)e[1], (double)e[2], (double)e[3]);
    }
    assert_int_equal(mirrored, 0);
    assert_int_equal(unknowns, 0);
    free_dump(&d);
    kiln_report_destroy(report);
}

static void normal_tangent_test(void **state) {
    (void)state;
    agree_with_blender(KILN_TEST_DATA "/mesh/normal_tangent_test.bin", 2e-5, 0, 0);
}

static void mirrored_seamed_and_degenerate(void **state) {
    (void)state;
    agree_with_blender(KILN_TEST_DATA "/mesh/mirrored.bin", 2e-5, 432, 18);
}

/* A square in the plane z = 0, whose picture is upright: u runs along x, v down along −y. The two triangles have the
 * rows of the square's corners. */
static const float square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
static const float upright[] = {0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0};
static const float facing[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};

static void square_in_closed_form(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    float uvs[12], t[24];
    for (int flip_u = 0; flip_u < 2; flip_u++)
        for (int flip_v = 0; flip_v < 2; flip_v++) {
            for (int c = 0; c < 6; c++) {
                uvs[2 * c] = flip_u ? 1 - upright[2 * c] : upright[2 * c];
                uvs[2 * c + 1] = flip_v ? 1 - upright[2 * c + 1] : upright[2 * c + 1];
            }
            assert_true(tangents_generate(square, facing, uvs, 2, t, report));
            for (int c = 0; c < 6; c++) {
                /* w · (z × t) must point up in the picture: along y, unless v is flipped. */
                const float expected[] = {flip_u ? -1 : 1, 0, 0, flip_u == flip_v ? 1 : -1};
                for (int k = 0; k < 4; k++) assert_true(t[4 * c + k] == expected[k]);
            }
        }
    kiln_report_destroy(report);
}

/* One half of the square mirrored: no average across the crease in uv, although position, normal and uv agree. */
static void mirrored_halves_stay_apart(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    /* u = x on the first triangle; u = y on the second, which mirrors it. They agree on the diagonal. */
    const float uvs[] = {0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 1, 1};
    float t[24];
    assert_true(tangents_generate(square, facing, uvs, 2, t, report));
    for (int c = 0; c < 3; c++) assert_true(t[4 * c] == 1 && t[4 * c + 1] == 0 && t[4 * c + 3] == 1);
    for (int c = 3; c < 6; c++) assert_true(t[4 * c] == 0 && t[4 * c + 1] == 1 && t[4 * c + 3] == -1);
    kiln_report_destroy(report);
}

static void triangles_without_extent_follow(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    float positions[27], normals[27], uvs[18], t[36];
    memcpy(positions, square, sizeof square);
    memcpy(normals, facing, sizeof facing);
    for (int k = 0; k < 12; k++) uvs[k] = k % 2 ? upright[k] : 1 - upright[k];
    /* Corners 0, 1, 1 of the square again. */
    memcpy(positions + 18, (const float[]){0, 0, 0, 1, 0, 0, 1, 0, 0}, 36);
    memcpy(normals + 18, facing, 36);
    memcpy(uvs + 12, (const float[]){1, 1, 0, 1, 0, 1}, 24);
    assert_true(tangents_generate(positions, normals, uvs, 3, t, report));
    for (int c = 6; c < 9; c++) assert_true(t[4 * c] == -1 && t[4 * c + 3] == -1);
    kiln_report_destroy(report);
}

static void any_input_gives_unit_tangents(void **state) {
    (void)state;
    const float evil[] = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e-45f, 0, 1};
    enum { COUNT = 4096 };
    float *values[3], *tangents = calloc(12 * COUNT, sizeof *tangents);
    uint32_t random = 1;
    for (int a = 0; a < 3; a++) {
        values[a] = calloc(9 * COUNT, sizeof(float));
        for (size_t i = 0; i < 9 * COUNT; i++) {
            random = random * 1664525u + 1013904223u;
            values[a][i] = random >> 28 ? (float)(random & 7) : evil[random >> 25 & 7];
        }
    }
    kiln_report *report = kiln_report_create();
    assert_true(tangents_generate(values[0], values[1], values[2], COUNT, tangents, report));
    for (uint32_t c = 0; c < 3 * COUNT; c++) {
        const float *t = tangents + 4 * (size_t)c;
        assert_true(fabsf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - 1) < 1e-5f);
        assert_true(t[3] == 1 || t[3] == -1);
    }
    assert_true(tangents_generate(NULL, NULL, NULL, 0, NULL, report));
    assert_false(tangents_generate(NULL, NULL, NULL, UINT32_MAX / 3, NULL, report));
    assert_int_equal(kiln_report_message(report, 0).code, KILN_CODE_LIMIT);
    kiln_report_destroy(report);
    for (int a = 0; a < 3; a++) free(values[a]);
    free(tangents);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_tangent_test),
        cmocka_unit_test(mirrored_seamed_and_degenerate),
        cmocka_unit_test(square_in_closed_form),
        cmocka_unit_test(mirrored_halves_stay_apart),
        cmocka_unit_test(triangles_without_extent_follow),
        cmocka_unit_test(any_input_gives_unit_tangents),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
