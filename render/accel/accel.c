#include "render/accel/accel.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/text.h"
#include "render/accel/coverage.h"
#include "render/accel/structure.h"

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
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | (HOLDS(w, SOLIDS) ? EMBREE_QUERY_FILTERS : RTC_SCENE_FLAG_NONE));
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
