#include "render/path/camera.h"

#include <stdlib.h>

#include "render/accel/accel.h"
#include "render/path/medium.h"
#include "render/world/lookup.h"

/* The camera's axes without scale; a camera that was flattened keeps what is left of it. */
static void set_frame(camera *c, const kiln_camera *from) {
    dvec3 back = d3_normalize(d3_load(from->transform + 8)), up = d3_load(from->transform + 4);
    if (!(d3_length(back) > 0)) back = (dvec3){0, 0, 1};
    dvec3 right = d3_normalize(d3_cross(up, back));
    if (!(d3_length(right) > 0)) right = d3_normalize(d3_cross(fabs(back.y) < 0.9 ? (dvec3){0, 1, 0} : (dvec3){1, 0, 0}, back));
    c->right = to_float(right);
    c->up = to_float(d3_cross(back, right));
    c->back = to_float(back);
}

/* Distance along the axis to what the middle of the picture sees; the scene's size when it sees nothing. */
static float focus_on_middle(const world *w, const camera *c) {
    vec3 d = v3_neg(c->back);
    float t, u, v;
    uint32_t triangle, instance;
    trace_counts counts = {0};
    ray_lanes ray = {&c->origin.x, &c->origin.y, &c->origin.z, &d.x, &d.y, &d.z, &c->near, &c->far, {0}, NULL, 1,
                     false};
    accel_closest(w, &ray, &t, &u, &v, &triangle, &instance, &counts);
    return triangle < TRIANGLE_REFUSED && t > 0 ? t : fmaxf(v3_length(c->origin), w->radius);
}

bool camera_make(const world *w, const kiln_camera *from, uint32_t width, uint32_t height, camera *c, kiln_report *report) {
    kiln_camera checked = *from;
    kiln_where where = where_root("camera");
    if (!camera_check(&checked, &where, report)) return false;
    from = &checked;
    *c = (camera){.origin = to_float(world_point(w, d3_load(from->transform + 12)))};
    set_frame(c, from);
    double aspect = (double)width / (double)height;
    c->orthographic = from->projection == KILN_ORTHOGRAPHIC ? 1.0f : 0.0f;
    double half_height = from->projection == KILN_ORTHOGRAPHIC ? from->ymag * w->scale : tan(0.5 * from->yfov_rad);
    c->half_height = (float)half_height;
    c->half_width = (float)(half_height * aspect);
    c->near = (float)fmax(from->znear * w->scale, 0);
    c->far = from->zfar > 0 ? (float)(from->zfar * w->scale) : INFINITY;
    c->lens_radius = (float)(from->lens_radius * w->scale);
    c->blades = from->blades >= 3 ? (float)from->blades : 0.0f;
    c->blade_rotation_turns = to_turns(from->blade_rotation_rad);
    c->focus = from->focus_distance > 0 ? (float)(from->focus_distance * w->scale) : 1.0f;
    if (c->lens_radius > 0 && !(from->focus_distance > 0)) c->focus = focus_on_middle(w, c);
    return true;
}

/* Enough that a hole in a mesh, or an edge that a ray slips through, is outvoted. */
enum { MEDIA_RAYS = 31 };

/* How many more backs than fronts of each medium the rays meet: a ray leaves a closed mesh once more than it enters it
 * when it starts inside, and as often when it starts outside. */
typedef struct media_count {
    const world *world;
    const float *dx, *dy, *dz;
    int32_t *counts; /* media_count of each ray */
} media_count;

static void count_crossing(void *user, uint32_t ray, const ray_crossing *c) {
    const media_count *m = user;
    const world *w = m->world;
    uint32_t medium = w->materials[w->triangle_material[c->triangle]].medium;
    float toward = v3_dot(lookup_facing(w, c->triangle, c->instance), v3(m->dx[ray], m->dy[ray], m->dz[ray]));
    m->counts[(size_t)ray * w->media_count + medium] += toward > 0.0f ? 1 : -1;
}

static int by_number(const void *a, const void *b) {
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* The median of the rays' counts, for each medium. */
static uint64_t vote(const world *w, const int32_t *counts) {
    uint64_t media = 0;
    for (uint32_t m = 1; m < w->media_count; m++) {
        int32_t sorted[MEDIA_RAYS];
        for (uint32_t r = 0; r < MEDIA_RAYS; r++) sorted[r] = counts[(size_t)r * w->media_count + m];
        qsort(sorted, MEDIA_RAYS, sizeof *sorted, by_number);
        for (int32_t k = 0; k < sorted[MEDIA_RAYS / 2] && k < 4; k++) media = medium_enter(media, m);
    }
    return media;
}

uint64_t camera_media(const world *w, const camera *c) {
    if (w->media_count < 2) return 0;
    float ox[MEDIA_RAYS], oy[MEDIA_RAYS], oz[MEDIA_RAYS], dx[MEDIA_RAYS], dy[MEDIA_RAYS], dz[MEDIA_RAYS];
    for (int i = 0; i < MEDIA_RAYS; i++) { /* a spiral over the sphere (Swinbank and Purser 2006): no axis, no plane */
        float z = 1.0f - (2.0f * (float)i + 1.0f) / (float)MEDIA_RAYS, r = sqrtf(1.0f - z * z);
        fm_pair a = fm_sincos_2pi(0.618033989f * (float)i);
        vec3 d = v3_normalize(v3(r * a.cos, r * a.sin, z));
        ox[i] = c->origin.x, oy[i] = c->origin.y, oz[i] = c->origin.z;
        dx[i] = d.x, dy[i] = d.y, dz[i] = d.z;
    }
    media_count m = {w, dx, dy, dz, array_alloc((size_t)MEDIA_RAYS * w->media_count, sizeof(int32_t))};
    if (!m.counts) return 0; /* a few kilobytes for each medium: the film will not be had either */
    trace_counts uncounted = {0};
    ray_lanes rays = {ox, oy, oz, dx, dy, dz, NULL, NULL, {0}, NULL, MEDIA_RAYS, false};
    accel_visit(w, &rays, count_crossing, &m, &uncounted);
    uint64_t media = vote(w, m.counts);
    free(m.counts);
    return media;
}
