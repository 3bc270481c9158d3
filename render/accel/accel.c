#include "render/accel/accel.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/text.h"
#include "render/accel/coverage.h"

struct accel {
    RTCDevice device;
    RTCScene scene;
    RTCScene *prototypes;
    uint32_t prototype_count;
    long long bytes; /* what Embree says that it allocated */
};

static bool monitor(void *user, ssize_t bytes, bool post) {
    (void)post;
    accel *a = user;
    __atomic_fetch_add(&a->bytes, (long long)bytes, __ATOMIC_RELAXED);
    return true;
}

/* Embree's geometry 0 is opaque, 1 has partial coverage; empty ones are left out. */
static void attach_triangles(accel *a, RTCScene scene, const world *w, const world_prototype *p) {
    for (uint32_t g = 0; g < 2; g++) {
        if (!p->count[g]) continue;
        RTCGeometry geometry = rtcNewGeometry(a->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, w->vertices, 0,
                                   sizeof *w->vertices, w->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, w->triangles,
                                   3 * sizeof(uint32_t) * p->first[g], 3 * sizeof(uint32_t), p->count[g]);
        if (g == 1) {
            rtcSetGeometryIntersectFilterFunction(geometry, coverage_filter);
            rtcSetGeometryOccludedFilterFunction(geometry, coverage_filter);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, g);
        rtcReleaseGeometry(geometry);
    }
}

static RTCScene new_scene(accel *a, const world *w) {
    RTCScene scene = rtcNewScene(a->device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | (w->media_count > 1 ? EMBREE_QUERY_FILTERS : RTC_SCENE_FLAG_NONE));
    /* HIGH falls back to MEDIUM with ROBUST without a word. */
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

static void attach_instances(accel *a, const world *w) {
    for (uint32_t i = 1; i < w->instance_count; i++) {
        const world_instance *copy = &w->instances[i];
        RTCGeometry geometry = rtcNewGeometry(a->device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, a->prototypes[copy->prototype]);
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, copy->m);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(a->scene, geometry, i + 1); /* 0 and 1 are the baked triangles */
        rtcReleaseGeometry(geometry);
    }
}

static bool check(accel *a, const char *doing, kiln_report *report) {
    enum RTCError error = rtcGetDeviceError(a->device);
    if (error == RTC_ERROR_NONE) return true;
    if (error == RTC_ERROR_OUT_OF_MEMORY) return report_no_memory(report, doing);
    return report_error(report, KILN_CODE_DEVICE, NULL, "check --embree-config", "Embree error %d while %s", (int)error,
                        doing);
}

/* Embree's own threads stay within kiln's budget; the user's configuration has the last word. */
static RTCDevice new_device(uint32_t threads, const char *config) {
    kiln_text text = {0};
    text_format(&text, "threads=%u%s%s", threads, config && *config ? "," : "", config ? config : "");
    RTCDevice device = text.data ? rtcNewDevice(text.data) : NULL;
    text_free(&text);
    return device;
}

static bool build(accel *a, world *w, uint32_t threads, const char *config, kiln_report *report) {
    a->device = new_device(threads, config);
    if (!a->device)
        return report_error(report, KILN_CODE_DEVICE, NULL, "check --embree-config",
                            "Embree cannot be started with the configuration '%s'", config ? config : "");
    rtcSetDeviceMemoryMonitorFunction(a->device, monitor, a);
    a->scene = new_scene(a, w);
    a->prototypes = array_alloc(w->prototype_count, sizeof(RTCScene));
    if (!a->prototypes) return report_no_memory(report, "building the acceleration structure");
    for (; a->prototype_count < w->prototype_count; a->prototype_count++) {
        RTCScene scene = new_scene(a, w);
        a->prototypes[a->prototype_count] = scene;
        attach_triangles(a, scene, w, &w->prototypes[a->prototype_count]);
        rtcCommitScene(scene);
    }
    attach_triangles(a, a->scene, w, &w->baked);
    attach_instances(a, w);
    rtcCommitScene(a->scene);
    return check(a, "building the acceleration structure", report);
}

bool accel_create(world *w, uint32_t threads, const char *config, kiln_report *report) {
    accel *a = calloc(1, sizeof *a);
    if (!a) return report_no_memory(report, "building the acceleration structure");
    w->accel = a;
    return build(a, w, threads, config, report);
}

void accel_destroy(accel *a) {
    if (!a) return;
    if (a->scene) rtcReleaseScene(a->scene);
    for (uint32_t i = 0; i < a->prototype_count; i++) rtcReleaseScene(a->prototypes[i]);
    if (a->device) rtcReleaseDevice(a->device);
    free(a->prototypes);
    free(a);
}

size_t accel_bytes(const accel *a) { return a->bytes > 0 ? (size_t)a->bytes : 0; }

void embree_version(char text[EMBREE_VERSION_MAX]) {
    RTCDevice device = rtcNewDevice("threads=1");
    unsigned v = device ? (unsigned)rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION) : 0;
    snprintf(text, EMBREE_VERSION_MAX, "%u.%u.%u", v / 10000, v / 100 % 100, v % 100);
    if (device) rtcReleaseDevice(device);
}

enum { WIDTH = 16 };

/* On a plane through the origin of an axis everything is exact, errors and offsets are 0, and Embree counts t = 0 as a
 * hit: rays that start on a surface start just behind 0. */
#define TNEAR_LEAST 0x1p-126f

/* A ray that Embree can take: finite, and of unit length but for rounding. x − x is 0 for finite x alone. */
static int is_ray(const struct RTCRay16 *r, int k) {
    float dx = r->dir_x[k], dy = r->dir_y[k], dz = r->dir_z[k], length2 = dx * dx + dy * dy + dz * dz;
    float o = r->org_x[k] + r->org_y[k] + r->org_z[k];
    return (length2 > 0.99f) & (length2 < 1.01f) & (o - o == 0.0f) & (r->tnear[k] >= 0.0f) & (r->tfar[k] >= 0.0f);
}

/* Loads lanes [first, first + WIDTH); returns how many exist. Missing and refused lanes become copies of a ray that is
 * one, switched off, for Embree asserts on all sixteen. */
static uint32_t load(const ray_lanes *rays, uint32_t first, struct RTCRay16 *r, int valid[WIDTH], trace_counts *counts) {
    uint32_t n = rays->count - first < WIDTH ? rays->count - first : WIDTH;
    int good = -1;
    for (uint32_t k = 0; k < WIDTH; k++) {
        uint32_t lane = first + (k < n ? k : 0), i = rays->lanes ? rays->lanes[lane] : lane;
        r->org_x[k] = rays->ox[i], r->org_y[k] = rays->oy[i], r->org_z[k] = rays->oz[i];
        r->dir_x[k] = rays->dx[i], r->dir_y[k] = rays->dy[i], r->dir_z[k] = rays->dz[i];
        r->tnear[k] = rays->tnear ? rays->tnear[i] : TNEAR_LEAST;
        r->tfar[k] = rays->tfar ? rays->tfar[i] : INFINITY;
        r->time[k] = 0.0f;
        r->mask[k] = ~0u;
        r->id[k] = i;
        r->flags[k] = 0;
    }
    for (int k = 0; k < WIDTH; k++) {
        valid[k] = is_ray(r, k) ? -1 : 0;
        if (valid[k]) good = k;
    }
    for (int k = 0; k < WIDTH; k++) {
        counts->refused += (uint32_t)k < n && !valid[k];
        if ((uint32_t)k >= n) valid[k] = 0;
        if (valid[k]) continue;
        r->org_x[k] = good < 0 ? 0.0f : r->org_x[good];
        r->org_y[k] = good < 0 ? 0.0f : r->org_y[good];
        r->org_z[k] = good < 0 ? 0.0f : r->org_z[good];
        r->dir_x[k] = good < 0 ? 0.0f : r->dir_x[good];
        r->dir_y[k] = good < 0 ? 0.0f : r->dir_y[good];
        r->dir_z[k] = good < 0 ? 1.0f : r->dir_z[good];
        r->tnear[k] = 0.0f;
        r->tfar[k] = -1.0f;
    }
    counts->rays += n;
    return n;
}

void accel_closest(const world *w, const ray_lanes *rays, float *t, float *u, float *v, uint32_t *triangle,
                   uint32_t *instance, trace_counts *counts) {
    coverage_context context = {.world = w, .coverage = &rays->coverage};
    embree_init_context(&context.embree);
    for (uint32_t first = 0; first < rays->count; first += WIDTH) {
        struct RTCRayHit16 packet;
        _Alignas(64) int valid[WIDTH];
        uint32_t n = load(rays, first, &packet.ray, valid, counts);
        for (int k = 0; k < WIDTH; k++) {
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.primID[k] = 0;
            packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        embree_intersect16(valid, w->accel->scene, &context.embree, &packet);
        for (uint32_t k = 0; k < n; k++) {
            uint32_t i = rays->lanes ? rays->lanes[first + k] : first + k, placed = packet.hit.instID[0][k];
            uint32_t copy = placed == RTC_INVALID_GEOMETRY_ID ? 0 : placed - 1;
            bool hit = packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
            t[i] = packet.ray.tfar[k];
            u[i] = packet.hit.u[k];
            v[i] = packet.hit.v[k];
            instance[i] = hit ? copy : 0;
            triangle[i] = hit        ? w->instances[copy].triangle_base[packet.hit.geomID[k]] + packet.hit.primID[k]
                          : valid[k] ? TRIANGLE_NONE
                                     : TRIANGLE_REFUSED;
        }
    }
}

void accel_visible(const world *w, const ray_lanes *rays, uint32_t *visible, trace_counts *counts) {
    coverage_context context = {.world = w, .coverage = &rays->coverage};
    embree_init_context(&context.embree);
    for (uint32_t first = 0; first < rays->count; first += WIDTH) {
        struct RTCRay16 packet;
        _Alignas(64) int valid[WIDTH];
        uint32_t n = load(rays, first, &packet, valid, counts);
        embree_occluded16(valid, w->accel->scene, &context.embree, &packet);
        for (uint32_t k = 0; k < n; k++) { /* Embree sets tfar to −∞ where something is hit */
            uint32_t i = rays->lanes ? rays->lanes[first + k] : first + k;
            visible[i] = !valid[k] ? RAY_REFUSED : packet.tfar[k] >= 0.0f ? RAY_REACHES : RAY_STOPPED;
        }
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
        struct RTCRay16 packet;
        _Alignas(64) int valid[WIDTH];
        (void)load(rays, first, &packet, valid, counts);
        embree_visit16(valid, w->accel->scene, &context.coverage.embree, visit_filter, &packet);
    }
}
