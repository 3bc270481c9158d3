/* Where rays begin and end, and what is no ray or no triangle. Seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/render/rays.h"

/* From inside a closed mesh no ray gets out, aimed at an edge or anywhere. Aimed at a vertex a few do: Embree decides
 * at each edge by a sign, and by rounding the signs of all edges around a vertex may say that the ray is beyond them.
 * */
static void closed_meshes_have_no_holes(void **state) {
    (void)state;
    scene_builder b = builder_make();
    add_sphere(&b, 0, (float[]){0, 0, 0}, 1, 40, 0);
    world *w = build_world(&b);
    rays r = rays_make(200000);
    stream s = {7, 0};
    for (uint32_t i = 0; i < r.count; i++) {
        const uint32_t *v = w->triangles + 3 * (size_t)(hash32(i) % w->triangle_count);
        vec3 p = v3_load(w->vertices[v[0]].p), q = v3_load(w->vertices[v[1]].p), o = stream_point(&s, 0.25f);
        vec3 aim = i % 3 == 0 ? p : i % 3 == 1 ? v3_lerp(p, q, stream_next(&s)) : stream_direction(&s);
        rays_set(&r, i, o, v3_normalize(v3_sub(aim, o)));
    }
    rays_closest(w, &r, NULL, r.count);
    uint32_t through_edges = 0, through_vertices = 0;
    for (uint32_t i = 0; i < r.count; i++)
        *(i % 3 == 0 ? &through_vertices : &through_edges) += r.triangle[i] == TRIANGLE_NONE;
    assert_int_equal(through_edges, 0);
    assert_true(through_vertices < r.count / 3 / 1000);
    rays_free(&r);
    world_destroy(w);
    builder_free(&b);
}

/* Three parallel walls: rays see from tnear to tfar. */
static void rays_begin_and_end(void **state) {
    (void)state;
    scene_builder b = builder_make();
    for (int i = 0; i < 3; i++) {
        float z = -(float)i;
        add_quad(&b, 0, (float[]){-4, -4, z, 4, -4, z, 4, 4, z, -4, 4, z});
    }
    world *w = build_world(&b);
    static const struct { double from, near, far, hit; } rows[] = {
        {1, 0, 1e9, 1},   {1, 1.5, 1e9, 2}, {1, 2.5, 1e9, 3}, {1, 3.5, 1e9, -1}, {1, 0, 0.5, -1},
        {1, 1.5, 1.8, -1}, {1, 0, 1.5, 1},  {-0.5, 0, 1e9, 0.5}, {-3, 0, 1e9, -1}, {1, 5, 2, -1}};
    double s = w->scale, top = 1; /* the walls' centre, z = −1, is the origin */
    for (int i = 0; i < 10; i++) {
        rays r = rays_make(1);
        rays_set(&r, 0, v3(0.125f, 0.0625f, (float)((rows[i].from + top) * s)), v3(0, 0, -1));
        r.tnear[0] = (float)(rows[i].near * s), r.tfar[0] = (float)(rows[i].far * s);
        rays_closest(w, &r, NULL, 1);
        rays_visible(w, &r);
        bool hits = rows[i].hit >= 0;
        if ((r.triangle[0] < TRIANGLE_REFUSED) != hits || (r.visible[0] == RAY_STOPPED) != hits ||
            (hits && fabs((double)r.t[0] - rows[i].hit * s) > 1e-6))
            fail_msg("row %d: triangle %u at %g", i, r.triangle[0], (double)r.t[0] / s);
        rays_free(&r);
    }
    world_destroy(w);
    builder_free(&b);
}

/* Points, lines and a scene of nothing else are no surfaces; a triangle among them is. */
static void degenerate_triangles_are_not_there(void **state) {
    (void)state;
    for (int with = 0; with < 2; with++) {
        scene_builder b = builder_make();
        const float p[15] = {-1, 0, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0, 0, 0, 1, 0};
        const uint32_t faces[15] = {0, 0, 0, 0, 1, 2, 1, 1, 3, 2, 1, 0, 0, 2, 4};
        kiln_mesh_desc desc = {.name = "degenerate", .vertex_count = 5, .positions = p, .face_count = with ? 5 : 4,
                               .face_vertices = faces};
        add_instance(&b, add_mesh(&b, &desc), NULL);
        world *w = build_world(&b);
        rays r = rays_make(2000);
        stream s = {8, 0};
        for (uint32_t i = 0; i < r.count; i++) {
            vec3 o = v3_scale(stream_direction(&s), 0.5f), on = v3(stream_between(&s, -0.5f, 0.5f), 0, 0);
            on.y = (float)(-w->center.y * w->scale); /* every ray passes the line */
            rays_set(&r, i, o, v3_normalize(v3_sub(on, o)));
        }
        rays_closest(w, &r, NULL, r.count);
        for (uint32_t i = 0; i < r.count; i++)
            assert_true(r.triangle[i] == TRIANGLE_NONE || (with && w->triangles[3 * (size_t)r.triangle[i] + 2] == 4));
        rays_free(&r);
        world_destroy(w);
        builder_free(&b);
    }
}

/* What is not a ray is refused and counted, also in a scene without any surface. */
static void strange_rays_are_refused(void **state) {
    (void)state;
    scene_builder a = builder_make(), b = builder_make();
    add_box(&a, 0, (float[]){-1, -1, -1}, (float[]){1, 1, 1});
    world *full = build_world(&a), *empty = build_world(&b);
    const float strange[] = {NAN, INFINITY, -INFINITY};
    for (int which = 0; which < 2; which++) {
        const world *w = which ? full : empty;
        rays r = rays_random(33, 1, 9);
        for (int i = 0; i < 3; i++) {
            r.ox[i] = r.oy[4 + i] = r.oz[8 + i] = r.dx[12 + i] = r.dy[16 + i] = r.dz[20 + i] = strange[i];
            r.dx[24 + i] = r.dy[24 + i] = r.dz[24 + i] = 0;
        }
        r.tnear[28] = -1, r.tnear[29] = NAN, r.tfar[30] = -1, r.dx[31] = 5;
        rays_closest(w, &r, NULL, r.count);
        rays_visible(w, &r);
        for (uint32_t i = 0; i < r.count; i++) {
            bool is_strange = i >= 28 ? i < 32 : i % 4 < 3;
            assert_true((r.triangle[i] == TRIANGLE_REFUSED) == is_strange);
            assert_true((r.visible[i] == RAY_REFUSED) == is_strange);
            if (!which && !is_strange) assert_true(r.triangle[i] == TRIANGLE_NONE && r.visible[i] == RAY_REACHES);
        }
        assert_int_equal(r.counts.rays, 66);
        assert_int_equal(r.counts.refused, 2 * 25);
        rays_free(&r);
    }
    world_destroy(full);
    world_destroy(empty);
    builder_free(&a);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_meshes_have_no_holes),
        cmocka_unit_test(rays_begin_and_end),
        cmocka_unit_test(degenerate_triangles_are_not_there),
        cmocka_unit_test(strange_rays_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
