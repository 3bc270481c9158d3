#include "render/world/world.h"

#include <stdlib.h>

#include "render/accel/accel.h"
#include "render/world/images.h"

static bool build(world *w, reduced_scene *scene, const world_build_options *o, kiln_report *report) {
    world_choose_space(w, scene->scene);
    return world_build_materials(w, scene, o, report) && world_build_geometry(w, scene, o->threads, report) &&
           world_build_lights(w, scene, o->decoding, o->threads, report) &&
           accel_create(w, o->threads, o->embree_config, report);
}

bool world_create(const kiln_scene *scene, const world_build_options *o, world **result, kiln_report *report) {
    reduced_scene reduced;
    *result = NULL;
    world *w = calloc(1, sizeof *w);
    if (!w) return report_no_memory(report, "building the scene");
    w->plan.asked = o->effects;
    bool done = reduced_make(&reduced, scene, effects_removed(&o->effects), report) && build(w, &reduced, o, report);
    reduced_free(&reduced);
    if (done) *result = w;
    else world_destroy(w);
    return done;
}

void world_destroy(world *w) {
    if (!w) return;
    accel_destroy(w->accel);
    images_free(w->images, w->image_count);
    arena_free(&w->arena);
    free(w);
}
