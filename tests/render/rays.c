#include "tests/render/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/bsdf/frame.h"

rays rays_make(uint32_t count) {
    rays r = {.count = count};
    float **floats[] = {&r.ox, &r.oy, &r.oz, &r.dx, &r.dy, &r.dz, &r.tnear, &r.tfar, &r.t, &r.u, &r.v};
    uint32_t **words[] = {&r.triangle, &r.instance, &r.visible};
    for (int i = 0; i < 11; i++) *floats[i] = calloc(count, sizeof(float));
    for (int i = 0; i < 3; i++) *words[i] = calloc(count, sizeof(uint32_t));
    for (uint32_t i = 0; i < count; i++) r.tnear[i] = 0x1p-126f, r.tfar[i] = INFINITY;
    return r;
}
void rays_free(rays *r) {
    float *floats[] = {r->ox, r->oy, r->oz, r->dx, r->dy, r->dz, r->tnear, r->tfar, r->t, r->u, r->v};
    for (int i = 0; i < 11; i++) free(floats[i]);
    free(r->triangle), free(r->instance), free(r->visible);
}
void rays_set(rays *r, uint32_t i, vec3 o, vec3 d) {
    r->ox[i] = o.x, r->oy[i] = o.y, r->oz[i] = o.z;
    r->dx[i] = d.x, r->dy[i] = d.y, r->dz[i] = d.z;
}
static ray_lanes lanes(const rays *r, const uint32_t *list, uint32_t count) {
    return (ray_lanes){r->ox, r->oy, r->oz, r->dx, r->dy, r->dz, r->tnear, r->tfar, {0}, list, count, false};
}
void rays_closest(const world *w, rays *r, const uint32_t *list, uint32_t count) {
    ray_lanes l = lanes(r, list, count);
    accel_closest(w, &l, r->t, r->u, r->v, r->triangle, r->instance, &r->counts);
}
void rays_visible(const world *w, rays *r) {
    ray_lanes l = lanes(r, NULL, r->count);
    accel_visible(w, &l, r->visible, &r->counts);
}
vec3 stream_point(stream *s, float reach) {
    float x = stream_between(s, -reach, reach), y = stream_between(s, -reach, reach);
    return v3(x, y, stream_between(s, -reach, reach));
}

vec3 rays_origin(const rays *r, uint32_t i) { return v3(r->ox[i], r->oy[i], r->oz[i]); }
vec3 rays_direction(const rays *r, uint32_t i) { return v3(r->dx[i], r->dy[i], r->dz[i]); }

rays rays_random(uint32_t count, float reach, uint32_t seed) {
    rays r = rays_make(count);
    stream s = {seed, 0};
    for (uint32_t i = 0; i < count; i++) rays_set(&r, i, stream_point(&s, reach), stream_direction(&s));
    return r;
}

void add_slivers(scene_builder *b, stream *s, uint32_t count, float width) {
    float *p = calloc(9 * count, sizeof *p);
    uint32_t *faces = calloc(3 * count, sizeof *faces);
    for (uint32_t i = 0; i < count; i++) {
        vec3 a = stream_point(s, 1), c = stream_point(s, 1);
        v3_store(p + 9 * i, a), v3_store(p + 9 * i + 3, c);
        v3_store(p + 9 * i + 6, v3_madd(v3_lerp(a, c, 0.5f), width, stream_direction(s)));
        for (uint32_t k = 0; k < 3; k++) faces[3 * i + k] = 3 * i + k;
    }
    kiln_mesh_desc desc = {.name = "slivers", .vertex_count = 3 * count, .positions = p, .face_count = count,
                           .face_vertices = faces};
    add_instance(b, add_mesh(b, &desc), NULL);
    free(p);
    free(faces);
}

kiln_id add_waves(scene_builder *b, kiln_id material, uint32_t n) {
    uint32_t side = n + 1, count = 0;
    float *p = calloc(3 * side * side, sizeof *p);
    uint32_t *faces = calloc(6 * n * n, sizeof *faces);
    for (uint32_t j = 0; j < side; j++)
        for (uint32_t i = 0; i < side; i++) {
            float x = 2 * (float)i / (float)n - 1, z = 2 * (float)j / (float)n - 1;
            v3_store(p + 3 * (j * side + i), v3(x, 0.2f * sinf(9 * x) * cosf(7 * z), z));
        }
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = j * side + i, quad[6] = {a, a + side, a + 1, a + 1, a + side, a + side + 1};
            memcpy(faces + count, quad, sizeof quad);
            count += 6;
        }
    kiln_mesh_desc desc = {.name = "waves", .vertex_count = side * side, .positions = p, .face_count = count / 3,
                           .face_vertices = faces, .material = material};
    kiln_id id = add_mesh(b, &desc);
    free(p);
    free(faces);
    return id;
}

void add_copies(scene_builder *b, kiln_id mesh, uint32_t count, stream *s) {
    for (uint32_t i = 0; i < count; i++) {
        frame f = frame_make(stream_direction(s));
        float size = powf(10, stream_between(s, -2.3f, -0.3f)), flat = stream_between(s, 0.1f, 1);
        vec3 x = v3_scale(f.x, size * (i & 1 ? -1.0f : 1.0f)), y = v3_scale(f.y, size * flat), z = v3_scale(f.z, size);
        vec3 at = stream_point(s, 1);
        const float m[16] = {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, at.x, at.y, at.z, 1};
        double transform[16];
        for (int k = 0; k < 16; k++) transform[k] = (double)m[k];
        add_instance(b, mesh, transform);
    }
}
