#include "tests/scene/support.h"

#include <math.h>
#include <stdlib.h>

#include "scene/triangulate.h"

/* One polygon of a mesh, cut; returns its triangles' corners (a static buffer). */
static const uint32_t *cut(const float *positions, uint32_t size, uint32_t *count) {
    static uint32_t corners[3 * 100000], faces[100000], order[100000];
    static uint32_t offsets[2];
    offsets[1] = size;
    for (uint32_t i = 0; i < size; i++) order[i] = i;
    kiln_mesh mesh = {.vertex_count = size, .time_count = 1, .face_count = 1, .corner_count = size,
                      .triangle_count = size - 2, .positions = positions, .face_offsets = offsets,
                      .face_vertices = order};
    assert_true(mesh_triangulate(&mesh, corners, faces));
    *count = size - 2;
    for (uint32_t t = 0; t < *count; t++) assert_int_equal(faces[t], 0);
    return corners;
}

static double signed_area(const float *a, const float *b, const float *c) {
    return 0.5 * (((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)b[1] - a[1]) * ((double)c[0] - a[0]));
}

/* Triangles that all wind like the polygon and whose areas add up to its area cover it exactly once. */
static void assert_covers(const float *p, uint32_t size, double area) {
    uint32_t count;
    const uint32_t *c = cut(p, size, &count);
    double sum = 0;
    for (uint32_t t = 0; t < count; t++, c += 3) {
        double a = signed_area(p + 3 * c[0], p + 3 * c[1], p + 3 * c[2]);
        assert_true(a >= -1e-9 * area);
        sum += a;
    }
    assert_true(fabs(sum - area) < 1e-6 * area);
}

static void quads_take_the_better_diagonal(void **state) {
    (void)state;
    uint32_t count;
    const float square[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    assert_memory_equal(cut(square, 4, &count), ((uint32_t[6]){0, 1, 2, 0, 2, 3}), sizeof(uint32_t[6]));
    const float kite_02[12] = {0, 0, 0, 3, -1, 0, .5f, 0, 0, 3, 1, 0}; /* concave at 2 */
    assert_memory_equal(cut(kite_02, 4, &count), ((uint32_t[6]){0, 1, 2, 0, 2, 3}), sizeof(uint32_t[6]));
    const float kite_13[12] = {3, -1, 0, .5f, 0, 0, 3, 1, 0, 0, 0, 0}; /* the same, concave at 1 */
    const float turned[12] = {3, 1, 0, 0, 0, 0, 3, -1, 0, .5f, 0, 0};  /* and counter-clockwise, concave at 3 */
    assert_memory_equal(cut(kite_13, 4, &count), ((uint32_t[6]){0, 1, 3, 1, 2, 3}), sizeof(uint32_t[6]));
    assert_memory_equal(cut(turned, 4, &count), ((uint32_t[6]){0, 1, 3, 1, 2, 3}), sizeof(uint32_t[6]));
    const float rhombus[12] = {-5, 0, 0, 0, -1, 0, 5, 0, 0, 0, 1, 0}; /* the short diagonal, 1–3 */
    assert_memory_equal(cut(rhombus, 4, &count), ((uint32_t[6]){0, 1, 3, 1, 2, 3}), sizeof(uint32_t[6]));
    for (int i = 0; i < 64; i++) { /* rectangles far from the origin are rounded, but stay alike */
        float x = 1000.1f + (float)i * .3f, y = 700.7f;
        const float p[12] = {x, y, 0, x + .3f, y, 0, x + .3f, y + .2f, 0, x, y + .2f, 0};
        assert_int_equal(cut(p, 4, &count)[2], 2);
    }
    for (int i = 0; i < 64; i++) { /* and so are turned squares */
        float c = 1.1f * cosf((float)i), s = 1.1f * sinf((float)i), x = 50;
        const float p[12] = {x, x, 0, x + c, x + s, 0, x + c - s, x + s + c, 0, x - s, x + c, 0};
        assert_int_equal(cut(p, 4, &count)[2], 2);
    }
}

static void polygons_are_covered_once(void **state) {
    (void)state;
    const float arrow[15] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 2, 1, 0, 0, 4, 0};
    assert_covers(arrow, 5, 16 - 6);
    for (int hole = 0; hole < 3; hole++) /* a square hole, joined by a bridge that is passed twice */
        for (int start = 0; start < 10; start++) {
            static const float outer[10] = {0, 0, 6, 0, 6, 6, 0, 6, 0, 0}, inner[8] = {4, 2, 2, 2, 2, 4, 4, 4};
            float p[30] = {0};
            for (int i = 0; i < 10; i++) {
                const float *from = i < 5 ? outer + 2 * i : inner + 2 * ((i - 5 + hole) % 4);
                int to = (i + start) % 10;
                p[3 * to] = from[0], p[3 * to + 1] = from[1];
            }
            assert_covers(p, 10, 36 - 4);
        }
    const float petals[27] = {/* three triangles that touch at a point, which the outline passes three times */
                              0, 0, 0, 2, -1, 0, 2, 1, 0, 0, 0, 0, 0, 2, 0, -2, 2, 0, 0, 0, 0, -2, -1, 0, -1, -2, 0};
    assert_covers(petals, 9, 2 + 2 + 1.5);
    enum { N = 2000 };
    static float star[3 * N], comb[3 * N];
    double area = 0;
    for (int i = 0; i < N; i++) {
        double r = i % 2 ? 1 : 3, a = 2 * M_PI * i / N;
        star[3 * i] = (float)(r * cos(a)), star[3 * i + 1] = (float)(r * sin(a));
    }
    for (int i = 0; i < N; i++) {
        const float *p = star + 3 * i, *q = star + 3 * ((i + 1) % N);
        area += 0.5 * ((double)p[0] * q[1] - (double)p[1] * q[0]);
    }
    assert_covers(star, N, area);
    for (int i = 0; i < N - 2; i++) comb[3 * i] = (float)(N - i), comb[3 * i + 1] = i % 2 ? 1 : 9;
    comb[3 * (N - 2)] = 3, comb[3 * (N - 2) + 1] = 0;
    comb[3 * (N - 1)] = (float)N, comb[3 * (N - 1) + 1] = 0;
    area = 0;
    for (int i = 0; i < N; i++) {
        const float *p = comb + 3 * i, *q = comb + 3 * ((i + 1) % N);
        area += 0.5 * ((double)p[0] * q[1] - (double)p[1] * q[0]);
    }
    assert_covers(comb, N, area);
}

static void a_plane_of_any_tilt_is_the_same(void **state) {
    (void)state;
    const float flat[18] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 2, 1, 0, 1, 2, 0, 0, 4, 0};
    uint32_t expected[12], count;
    memcpy(expected, cut(flat, 6, &count), sizeof expected);
    for (int axis = 0; axis < 3; axis++) {
        float p[18];
        for (int i = 0; i < 6; i++)
            for (int k = 0; k < 3; k++) p[3 * i + (k + axis) % 3] = flat[3 * i + k] * 1e-6f;
        assert_memory_equal(cut(p, 6, &count), expected, sizeof expected);
    }
}

/* Whatever the polygon is, n − 2 triangles come out and every corner is used. */
static void degenerate_polygons_end(void **state) {
    (void)state;
    enum { N = 100000 };
    static float p[3 * N];
    static bool used[N];
    const uint32_t sizes[] = {4, 5, 6, 17, 1000, N};
    for (int shape = 0; shape < 5; shape++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            uint32_t n = sizes[s], count, seed = 1;
            for (uint32_t i = 0; i < n; i++) {
                seed = seed * 1664525u + 1013904223u;
                float x = (float)(int32_t)(seed >> 16), y = (float)(int32_t)(seed & 0xffff);
                float random[3] = {x, y, 0}, line[3] = {(float)i, (float)i, 0}, huge[3] = {x * 1e33f, y * 1e33f, 0};
                float tooth[3] = {(float)i, i % 2 ? 1.0f : 0, 0};
                const float *source = shape == 1 ? random : shape == 2 ? line : shape == 3 ? huge : tooth;
                for (int k = 0; k < 3; k++) p[3 * i + (uint32_t)k] = shape == 0 ? 0 : source[k];
            }
            if (n == N && shape == 3) continue; /* the budget is spent once, by shape 1 */
            const uint32_t *c = cut(p, n, &count);
            memset(used, 0, n);
            for (uint32_t i = 0; i < 3 * count; i++) {
                assert_true(c[i] < n);
                used[c[i]] = true;
            }
            for (uint32_t i = 0; i < n; i++) assert_true(used[i]);
        }
}

static void faces_of_all_sizes_share_a_mesh(void **state) {
    fixture *f = *state;
    const float p[21] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0, 0, -1, 1, 0, -2, .5f, 0};
    const uint32_t sizes[3] = {3, 5, 4}, vertices[12] = {0, 1, 2, 0, 3, 5, 6, 4, 0, 1, 2, 3};
    kiln_mesh_desc desc = {.vertex_count = 7, .positions = p, .face_count = 3, .face_sizes = sizes,
                           .face_vertices = vertices};
    assert_true(kiln_scene_add_mesh(f->scene, &desc, NULL, f->report));
    uint32_t corners[18], faces[6];
    assert_true(mesh_triangulate(scene_mesh(f->scene, 1), corners, faces));
    assert_memory_equal(faces, ((uint32_t[6]){0, 1, 1, 1, 2, 2}), sizeof faces);
    for (int i = 0; i < 18; i++) assert_true(corners[i] < (i < 3 ? 3 : i < 12 ? 8 : 12));
    assert_memory_equal(corners, ((uint32_t[3]){0, 1, 2}), sizeof(uint32_t[3]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quads_take_the_better_diagonal),
        cmocka_unit_test(polygons_are_covered_once),
        cmocka_unit_test(a_plane_of_any_tilt_is_the_same),
        cmocka_unit_test(degenerate_polygons_end),
        SCENE_TEST(faces_of_all_sizes_share_a_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
