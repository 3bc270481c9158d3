/* Points on surfaces: rays that leave one do not meet it again, frames are orthonormal, attributes are interpolated,
 * and the side that is seen is known. Seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "render/bsdf/frame.h"
#include "render/path/surface.h"
#include "tests/render/rays.h"

static vec3 place(const world_instance *c, const float *p) {
    const float *m = c->m;
    return v3(m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3], m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
              m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]);
}

/* Ray i's hit, as the stages make it. */
static surface_point point_of(const world *w, const rays *r, uint32_t i) {
    const uint32_t *v = w->triangles + 3 * (size_t)r->triangle[i];
    const world_instance *c = &w->instances[r->instance[i]];
    surface_triangle t = {.side = c->side, .magnitude = c->magnitude, .embree = {r->u[i], r->v[i], r->t[i]}};
    vec3 *corners[3] = {&t.p0, &t.p1, &t.p2};
    for (int k = 0; k < 3; k++) {
        const float *p = w->vertices[v[k]].p;
        *corners[k] = r->instance[i] ? place(c, p) : v3_load(p);
    }
    return surface_at(rays_origin(r, i), rays_direction(r, i), &t);
}

/* Rays that leave hit points in all directions, as surface_flat_sides has it. leaves: those that do. */
typedef struct spawned { rays rays; uint32_t *from_triangle, *from_instance; bool *outward; } spawned;

static spawned spawn(const world *w, const rays *r, uint32_t seed) {
    spawned s = {rays_make(r->count), calloc(r->count, sizeof(uint32_t)), calloc(r->count, sizeof(uint32_t)),
                 calloc(r->count, sizeof(bool))};
    stream random = {seed, 0};
    uint32_t n = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        vec3 d = stream_direction(&random);
        if (r->triangle[i] >= TRIANGLE_REFUSED) continue;
        surface_point p = point_of(w, r, i);
        if (i % 4 == 0) d = v3_normalize(v3_madd(d, -0.99f * v3_dot(d, p.geometric), p.geometric)); /* grazing */
        bool up = v3_dot(d, p.geometric) > 0;
        rays_set(&s.rays, n, v3_madd(p.position, up ? p.reach : -p.reach, p.geometric), d);
        s.from_triangle[n] = r->triangle[i], s.from_instance[n] = r->instance[i];
        s.outward[n] = up == (p.front > 0.5f);
        n++;
    }
    s.rays.count = n;
    rays_closest(w, &s.rays, NULL, n);
    return s;
}
static void spawned_free(spawned *s) {
    rays_free(&s->rays);
    free(s->from_triangle), free(s->from_instance), free(s->outward);
}

static uint32_t self_hits(const spawned *s) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->rays.count; i++)
        count += s->rays.triangle[i] == s->from_triangle[i] && s->rays.instance[i] == s->from_instance[i];
    return count;
}

/* Waves of sizes 10⁻⁶ to 10⁶, at the origin and far from it: a plane triangle is never met again. */
static void nothing_hits_itself(void **state) {
    (void)state;
    for (int power = -6; power <= 6; power += 2)
        for (int far = 0; far < 3; far++) {
            scene_builder b = builder_make();
            stream s = {61, 0};
            double size = pow(10, power), away = far ? pow(10, 3 * far) * size : 0;
            double at[16] = {size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, 0, away, -0.7 * away, 0.3 * away, 1};
            add_instance(&b, add_waves(&b, 0, 24), at);
            if (far == 2) /* something else there, so that coordinates keep few digits */
                add_box(&b, 0, (float[]){0, 0, 0}, (float[]){(float)size, (float)size, (float)size});
            world *w = build_world(&b);
            float reach = (float)(size * w->scale), middle = (float)w->scale;
            rays r = rays_make(20000);
            for (uint32_t i = 0; i < r.count; i++) {
                vec3 c = v3((float)((away - w->center.x)) * middle, (float)((-0.7 * away - w->center.y)) * middle,
                            (float)((0.3 * away - w->center.z)) * middle);
                rays_set(&r, i, v3_add(c, stream_point(&s, 1.2f * reach)), stream_direction(&s));
            }
            rays_closest(w, &r, NULL, r.count);
            spawned p = spawn(w, &r, 62);
            uint32_t bad = self_hits(&p);
            if (bad || p.rays.count < 500)
                fail_msg("size 1e%d, %g away: %u of %u hit themselves", power, away, bad, p.rays.count);
            spawned_free(&p);
            rays_free(&r);
            world_destroy(w);
            builder_free(&b);
        }
}

/* Needles, looked at from all around. */
static double needles_self_hits(float width) {
    scene_builder b = builder_make();
    stream s = {72, 0};
    add_slivers(&b, &s, 500, width);
    world *w = build_world(&b);
    rays r = rays_make(30000);
    for (uint32_t i = 0; i < r.count; i++) {
        const uint32_t *v = w->triangles + 3 * (size_t)(i % w->triangle_count);
        vec3 a = v3_load(w->vertices[v[0]].p), c = v3_load(w->vertices[v[1]].p), d = v3_load(w->vertices[v[2]].p);
        vec3 aim = v3_lerp(v3_lerp(a, c, stream_next(&s)), d, stream_next(&s)), away = stream_direction(&s);
        rays_set(&r, i, v3_madd(aim, 0.2f, away), v3_neg(away));
    }
    rays_closest(w, &r, NULL, r.count);
    spawned p = spawn(w, &r, 74);
    assert_true(p.rays.count > 3000);
    double share = (double)self_hits(&p) / p.rays.count;
    spawned_free(&p);
    rays_free(&r);
    world_destroy(w);
    builder_free(&b);
    return share;
}
/* None up to 1 : 300; beyond, the plane of a needle is known to less than its width, and some are met again. */
static void needles_hardly_hit_themselves(void **state) {
    (void)state;
    static const struct { float width; double at_most; } rows[] = {{0.1f, 0}, {0.01f, 0}, {0.003f, 0}, {1e-3f, 1e-3},
                                                                   {3e-4f, 0.01}, {1e-5f, 0.15}};
    for (int i = 0; i < 6; i++) {
        double share = needles_self_hits(rows[i].width);
        if (share > rows[i].at_most) fail_msg("width %g: %g hit themselves", (double)rows[i].width, share);
    }
}

/* The same through the transforms of copies, which round once more. */
static void copies_do_not_hit_themselves(void **state) {
    (void)state;
    scene_builder b = builder_make();
    stream s = {63, 0};
    add_copies(&b, add_waves(&b, 0, 128), 40, &s);
    world *w = build_world(&b);
    assert_int_equal(w->instance_count, 41);
    rays r = rays_random(100000, 0.7f * w->radius, 64);
    rays_closest(w, &r, NULL, r.count);
    spawned p = spawn(w, &r, 65);
    assert_true(p.rays.count > 5000);
    assert_int_equal(self_hits(&p), 0);
    spawned_free(&p);
    rays_free(&r);
    world_destroy(w);
    builder_free(&b);
}

/* On a ball: what leaves outwards meets nothing, what goes inwards meets the other side. */
static void balls_are_tight(void **state) {
    (void)state;
    static const struct { float radius, x; } rows[] = {{1, 0}, {1e-6f, 0}, {1e6f, 0}, {1, 16}, {1e-3f, 0.01f}};
    for (int row = 0; row < 5; row++) {
        scene_builder b = builder_make();
        float radius = rows[row].radius;
        add_sphere(&b, 0, (float[]){rows[row].x, 0, 0}, radius, 32, SPHERE_FLAT);
        world *w = build_world(&b);
        rays r = rays_make(50000);
        stream s = {66, 0};
        for (uint32_t i = 0; i < r.count; i++) {
            vec3 aim = stream_point(&s, 0.2f), from = v3_scale(stream_direction(&s), i & 1 ? 1.5f : 0.1f);
            rays_set(&r, i, from, v3_normalize(v3_sub(aim, from)));
        }
        rays_closest(w, &r, NULL, r.count);
        spawned p = spawn(w, &r, 67);
        assert_int_equal(p.rays.count, r.count);
        uint32_t wrong = 0;
        for (uint32_t i = 0; i < p.rays.count; i++) wrong += p.outward[i] != (p.rays.triangle[i] == TRIANGLE_NONE);
        if (wrong) fail_msg("ball %g at %g: %u wrong of %u", (double)radius, (double)rows[row].x, wrong, p.rays.count);
        spawned_free(&p);
        rays_free(&r);
        world_destroy(w);
        builder_free(&b);
    }
}

static vec3 random_unit_or_axis(stream *s, int i) {
    static const vec3 axes[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1e-4f, 0, -1}, {0, 1e-8f, -1}};
    return i < 6 ? v3_normalize(axes[i]) : stream_direction(s);
}

static void frames_are_orthonormal(void **state) {
    (void)state;
    stream s = {68, 0};
    for (int i = 0; i < 20000; i++) {
        vec3 n = random_unit_or_axis(&s, i), v = stream_direction(&s);
        frame f = frame_make(n);
        assert_true(fabsf(v3_dot(f.x, f.y)) < 1e-6f && fabsf(v3_dot(f.x, n)) < 1e-6f && fabsf(v3_dot(f.y, n)) < 1e-6f);
        assert_true(fabsf(v3_length(f.x) - 1) < 1e-6f && fabsf(v3_length(f.y) - 1) < 1e-6f);
        assert_true(v3_dot(v3_cross(f.x, f.y), n) > 0.999999f);
        vec3 there = frame_to_local(&f, v), back = frame_to_world(&f, there);
        assert_true(v3_length(v3_sub(back, v)) < 1e-6f && fabsf(there.z - v3_dot(v, n)) < 1e-6f);
    }
}

/* glTF 2.0, 3.7.2.1 and 3.9.3: normalize(x T + y B + z N), B = w N × T. From behind, z's side is kept and the relief is
 * turned over with the surface. */
static void normal_maps_bend(void **state) {
    (void)state;
    stream s = {69, 0};
    for (int i = 0; i < 5000; i++) {
        frame f = frame_make(stream_direction(&s));
        float w = i & 1 ? 1.0f : -1.0f, lean = stream_between(&s, -3, 3);
        vec3 map = v3(stream_between(&s, -1, 1), stream_between(&s, -1, 1), stream_between(&s, 0.1f, 1));
        vec3 t = v3_madd(f.x, lean, f.z); /* tangents need not be orthogonal */
        vec3 expected = v3_normalize(v3_madd(v3_madd(v3_scale(f.x, map.x), w * map.y, f.y), map.z, f.z));
        vec3 front = surface_map(f.z, t, w, map, 1), behind = surface_map(v3_neg(f.z), t, w, map, 0);
        assert_true(v3_length(v3_sub(front, expected)) < 1e-5f && v3_length(v3_add(behind, expected)) < 1e-5f);
    }
    vec3 n = v3(0, 0, 1), flat = surface_map(n, v3(1, 0, 0), 1, v3(0, 0, 0.3f), 1);
    assert_true(v3_dot(flat, n) == 1);
    vec3 none = surface_map(n, v3(0, 0, 2), 1, v3(1, 0, 0), 1), zero = surface_map(n, v3(0, 0, 0), 1, v3(1, 1, 1), 1);
    assert_true(none.z == 1 && zero.z == 1); /* no tangent, no map */
}

/* A normal that faces away is turned until wo grazes it; others stay. */
static void normals_face_the_viewer(void **state) {
    (void)state;
    stream s = {70, 0};
    for (int i = 0; i < 20000; i++) {
        vec3 n = stream_direction(&s), wo = i < 3 ? v3_scale(n, i == 1 ? 1.0f : -1.0f) : stream_direction(&s);
        vec3 faced = surface_face(n, wo);
        float c = v3_dot(n, wo);
        assert_true(fabsf(v3_length(faced) - 1) < 1e-5f);
        if (c >= 0.01f) assert_true(v3_length(v3_sub(faced, n)) == 0);
        else assert_true(v3_dot(faced, wo) > 0.0099f);
        if (c < -0.99f) continue; /* against wo a normal has no direction of its own */
        assert_true(v3_dot(faced, n) > 0 && fabsf(v3_dot(v3_cross(n, wo), faced)) < 1e-5f); /* in the plane of both */
    }
}

/* A hit at known barycentric coordinates: position, UV and normal are sums of the corners', the area half the cross
 * product, front where the triangle winds counter-clockwise, turned over for mirrored copies. */
static void hits_interpolate(void **state) {
    (void)state;
    stream s = {71, 0};
    for (int i = 0; i < 5000; i++) {
        surface_triangle t = {.side = i & 1 ? 1.0f : -1.0f};
        t.p0 = stream_point(&s, 1), t.p1 = stream_point(&s, 1), t.p2 = stream_point(&s, 1);
        vec3 e1 = v3_sub(t.p1, t.p0), e2 = v3_sub(t.p2, t.p0), cross = v3_cross(e1, e2), n = v3_normalize(cross);
        t.n0 = v3_normalize(v3_madd(n, 0.3f, stream_direction(&s)));
        t.n1 = v3_normalize(v3_madd(n, 0.3f, stream_direction(&s)));
        t.n2 = v3_normalize(v3_madd(n, 0.3f, stream_direction(&s)));
        t.uv0 = stream_pair(&s), t.uv1 = stream_pair(&s), t.uv2 = stream_pair(&s);
        vec2 b = stream_pair(&s);
        if (b.x + b.y > 1) b = (vec2){1 - b.x, 1 - b.y};
        float b0 = 1 - b.x - b.y;
        vec3 at = v3_madd(v3_madd(t.p0, b.x, e1), b.y, e2), d = stream_direction(&s);
        float slant = fabsf(v3_dot(n, d));
        if (v3_length(cross) < 0.1f || slant < 0.1f) continue;
        surface_point p = surface_at(v3_madd(at, -2, d), d, &t);
        vec3 smooth = v3_normalize(v3_madd(v3_madd(v3_scale(t.n0, b0), b.x, t.n1), b.y, t.n2));
        bool front = v3_dot(n, d) * t.side < 0;
        float seen = v3_dot(n, d) < 0 ? 1.0f : -1.0f;
        assert_true(fabsf(p.hit.t - 2) < 1e-4f && v3_length(v3_sub(p.position, at)) < 1e-4f);
        assert_true(fabsf(p.uv.x - (b0 * t.uv0.x + b.x * t.uv1.x + b.y * t.uv2.x)) < 1e-4f);
        assert_true(fabsf(p.uv.y - (b0 * t.uv0.y + b.x * t.uv1.y + b.y * t.uv2.y)) < 1e-4f);
        assert_true((p.front > 0.5f) == front && v3_length(v3_sub(p.geometric, v3_scale(n, seen))) < 1e-5f);
        assert_true(v3_length(v3_sub(p.shading, v3_scale(smooth, seen))) < 1e-3f);
        assert_true(fabsf(p.area - 0.5f * v3_length(cross)) < 1e-6f);
        t.n0 = t.n1 = t.n2 = v3(0, 0, 0); /* flat */
        p = surface_at(v3_madd(at, -2, d), d, &t);
        assert_true(v3_length(v3_sub(p.shading, p.geometric)) == 0);
    }
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_hits_itself),    cmocka_unit_test(copies_do_not_hit_themselves),
        cmocka_unit_test(needles_hardly_hit_themselves), cmocka_unit_test(balls_are_tight),
        cmocka_unit_test(frames_are_orthonormal),
        cmocka_unit_test(normal_maps_bend),       cmocka_unit_test(normals_face_the_viewer),
        cmocka_unit_test(hits_interpolate),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
