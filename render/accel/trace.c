/* render/accel/trace.c: rays in arrays become Embree's packets, and what they meet arrays again. Compiled as the stages
 * are, once per instruction set: without it, filling packets takes a tenth of a small scene's time. */
#include <string.h>

#include "render/accel/coverage.h"
#include "render/accel/structure.h"

enum { WIDTH = 16 };

/* On a plane through the origin of an axis everything is exact, errors and offsets are 0, and Embree counts t = 0 as a
 * hit: rays that start on a surface start just behind 0. */
#define TNEAR_LEAST 0x1p-126f

/* A packet being filled: which rays they are, and which of its lanes Embree looks at. */
typedef struct packet {
    _Alignas(64) int valid[WIDTH];
    _Alignas(64) uint32_t index[WIDTH];
    uint32_t count; /* of rays; the lanes behind them repeat the first */
    bool in_order;  /* index[k] is index[0] + k, in all lanes */
} packet;

static void choose(const ray_lanes *rays, uint32_t first, packet *p) {
    uint32_t left = rays->count - first;
    p->count = left < WIDTH ? left : WIDTH;
    p->in_order = !rays->lanes && p->count == WIDTH;
    for (uint32_t k = 0; k < WIDTH; k++) {
        uint32_t lane = first + (k < p->count ? k : 0);
        p->index[k] = rays->lanes ? rays->lanes[lane] : lane;
    }
}

static void copy(const packet *p, const float *from, float *to) {
    if (p->in_order) for (uint32_t k = 0; k < WIDTH; k++) to[k] = from[p->index[0] + k];
    else for (uint32_t k = 0; k < WIDTH; k++) to[k] = from[p->index[k]];
}
static void copy_or_fill(const packet *p, const float *from, float otherwise, float *to) {
    if (from) copy(p, from, to);
    else for (uint32_t k = 0; k < WIDTH; k++) to[k] = otherwise;
}

/* Rays that Embree can take: finite, and of unit length but for rounding. x − x is 0 for finite x alone. */
static void check_rays(const struct RTCRay16 *r, int valid[WIDTH]) {
    for (uint32_t k = 0; k < WIDTH; k++) {
        float dx = r->dir_x[k], dy = r->dir_y[k], dz = r->dir_z[k], length2 = dx * dx + dy * dy + dz * dz;
        float o = r->org_x[k] + r->org_y[k] + r->org_z[k];
        int good = (length2 > 0.99f) & (length2 < 1.01f) & (o - o == 0.0f) & (r->tnear[k] >= 0.0f) & (r->tfar[k] >= 0.0f);
        valid[k] = -good;
    }
}

/* Missing and refused lanes become copies of a ray that is one, switched off, for Embree asserts on all sixteen. */
static void repair(struct RTCRay16 *r, packet *p, trace_counts *counts) {
    int good = -1;
    for (int k = 0; k < WIDTH; k++) {
        if (p->valid[k]) good = k;
        else counts->refused += (uint32_t)k < p->count;
    }
    for (int k = 0; k < WIDTH; k++) {
        if ((uint32_t)k >= p->count) p->valid[k] = 0;
        if (p->valid[k]) continue;
        r->org_x[k] = good < 0 ? 0.0f : r->org_x[good];
        r->org_y[k] = good < 0 ? 0.0f : r->org_y[good];
        r->org_z[k] = good < 0 ? 0.0f : r->org_z[good];
        r->dir_x[k] = good < 0 ? 0.0f : r->dir_x[good];
        r->dir_y[k] = good < 0 ? 0.0f : r->dir_y[good];
        r->dir_z[k] = good < 0 ? 1.0f : r->dir_z[good];
        r->tnear[k] = 0.0f;
        r->tfar[k] = -1.0f;
    }
}

/* Loads up to WIDTH rays from `first` on. */
static void load(const ray_lanes *rays, uint32_t first, struct RTCRay16 *r, packet *p, trace_counts *counts) {
    choose(rays, first, p);
    copy(p, rays->ox, r->org_x), copy(p, rays->oy, r->org_y), copy(p, rays->oz, r->org_z);
    copy(p, rays->dx, r->dir_x), copy(p, rays->dy, r->dir_y), copy(p, rays->dz, r->dir_z);
    copy_or_fill(p, rays->tnear, TNEAR_LEAST, r->tnear);
    copy_or_fill(p, rays->tfar, INFINITY, r->tfar);
    int all = -1;
    check_rays(r, p->valid);
    for (uint32_t k = 0; k < WIDTH; k++) {
        r->time[k] = 0.0f;
        r->mask[k] = ~0u;
        r->id[k] = p->index[k];
        r->flags[k] = 0;
        all &= p->valid[k];
    }
    counts->rays += p->count;
    if (!all || p->count < WIDTH) repair(r, p, counts);
}

/* Where a triangle that Embree names stands in the world. */
static uint32_t name_hit(const world *w, const struct RTCHit16 *h, uint32_t k, int valid, uint32_t *instance) {
    *instance = 0;
    if (h->geomID[k] == RTC_INVALID_GEOMETRY_ID) return valid ? TRIANGLE_NONE : TRIANGLE_REFUSED;
    return filter_triangle(w, (const uint32_t *)(const void *)h, WIDTH, k, instance);
}

/* The same for sixteen of a world that keeps no copies. */
static void name_baked(const world *w, const struct RTCHit16 *h, const packet *p, uint32_t *triangle, uint32_t *instance) {
    uint32_t opaque = w->instances[0].triangle_base[0], covered = w->instances[0].triangle_base[1];
    for (uint32_t k = 0; k < WIDTH; k++) {
        uint32_t missed = p->valid[k] ? TRIANGLE_NONE : TRIANGLE_REFUSED, geometry = h->geomID[k];
        uint32_t met = (geometry == 1 ? covered : opaque) + h->primID[k];
        triangle[k] = geometry == RTC_INVALID_GEOMETRY_ID ? missed : met;
        instance[k] = 0;
    }
}

/* For a render that is recorded; NULL: this packet is not. */
static tape_packet *keep(const trace_counts *counts, tape_query query, const struct RTCRay16 *r, const packet *p,
                         const ray_coverage *coverage) {
    return counts->tape ? tape_add(counts->tape, query, r, p->valid, coverage) : NULL;
}

void accel_closest(const world *w, const ray_lanes *rays, float *t, float *u, float *v, uint32_t *triangle,
                   uint32_t *instance, trace_counts *counts) {
    coverage_context context = {.world = w, .coverage = &rays->coverage};
    embree_init_context(&context.embree);
    for (uint32_t first = 0; first < rays->count; first += WIDTH) {
        struct RTCRayHit16 r;
        packet p;
        load(rays, first, &r.ray, &p, counts);
        for (int k = 0; k < WIDTH; k++) {
            r.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            r.hit.primID[k] = 0;
            r.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        tape_packet *kept = keep(counts, rays->coherent ? TAPE_BEAM : TAPE_CLOSEST, &r.ray, &p, &rays->coverage);
        embree_intersect16(p.valid, w->accel->scene, &context.embree, rays->coherent, &r);
        if (kept) tape_met(kept, &r.ray);
        if (p.in_order && w->instance_count == 1) {
            memcpy(t + first, r.ray.tfar, sizeof r.ray.tfar);
            memcpy(u + first, r.hit.u, sizeof r.hit.u);
            memcpy(v + first, r.hit.v, sizeof r.hit.v);
            name_baked(w, &r.hit, &p, triangle + first, instance + first);
            continue;
        }
        for (uint32_t k = 0; k < p.count; k++) {
            uint32_t i = p.index[k];
            t[i] = r.ray.tfar[k], u[i] = r.hit.u[k], v[i] = r.hit.v[k];
            triangle[i] = name_hit(w, &r.hit, k, p.valid[k], &instance[i]);
        }
    }
}

void accel_visible(const world *w, const ray_lanes *rays, uint32_t *visible, trace_counts *counts) {
    coverage_context context = {.world = w, .coverage = &rays->coverage};
    embree_init_context(&context.embree);
    for (uint32_t first = 0; first < rays->count; first += WIDTH) {
        struct RTCRay16 r;
        packet p;
        load(rays, first, &r, &p, counts);
        tape_packet *kept = keep(counts, TAPE_VISIBLE, &r, &p, &rays->coverage);
        embree_occluded16(p.valid, w->accel->scene, &context.embree, &r);
        if (kept) tape_met(kept, &r);
        for (uint32_t k = 0; k < p.count; k++) /* Embree sets tfar to −∞ where something is hit */
            visible[p.index[k]] = !p.valid[k] ? RAY_REFUSED : r.tfar[k] >= 0.0f ? RAY_REACHES : RAY_STOPPED;
    }
}

/* What a visit hands to its filter. */
typedef struct visit_context {
    coverage_context coverage;
    ray_visitor *visitor;
    void *user;
} visit_context;

/* Shows the hits, and accepts none: Embree goes on to the ray's end. */
static void visit_filter(const struct RTCFilterFunctionNArguments *args) {
    const visit_context *c = (const visit_context *)(const void *)args->context;
    const uint32_t *ray = (const uint32_t *)(const void *)args->ray, *hit = (const uint32_t *)(const void *)args->hit;
    const float *ray_f = (const float *)(const void *)args->ray, *hit_f = (const float *)(const void *)args->hit;
    size_t n = args->N;
    for (size_t k = 0; k < n; k++) {
        if (args->valid[k] != -1) continue;
        ray_crossing at = {.t = ray_f[RAY_T * n + k], .u = hit_f[HIT_U * n + k], .v = hit_f[HIT_V * n + k]};
        at.triangle = filter_triangle(c->coverage.world, hit, n, k, &at.instance);
        c->visitor(c->user, ray[RAY_ID * n + k], &at);
        args->valid[k] = 0;
    }
}

void accel_visit(const world *w, const ray_lanes *rays, ray_visitor *visitor, void *user, trace_counts *counts) {
    visit_context context = {{.world = w, .coverage = &rays->coverage}, visitor, user};
    embree_init_context(&context.coverage.embree);
    for (uint32_t first = 0; first < rays->count; first += WIDTH) {
        struct RTCRay16 r;
        packet p;
        load(rays, first, &r, &p, counts);
        (void)keep(counts, TAPE_VISIT, &r, &p, &rays->coverage);
        embree_visit16(p.valid, w->accel->scene, &context.coverage.embree, visit_filter, &r);
    }
}
