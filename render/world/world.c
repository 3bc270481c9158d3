#include "render/world/world.h"

#include <stdlib.h>

#include "render/accel/accel.h"
#include "render/world/images.h"

/* Surfaces that shine: lights, which are sampled, and unlit ones, which are only ever met. */
static void note_emission(world *w) {
    for (uint32_t i = 0; i < w->material_count; i++) {
        const world_material *m = &w->materials[i];
        w->emits |= m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0;
    }
    for (uint32_t i = 0; i < w->lights.count; i++) {
        w->lights.varied |= w->lights.lights[i].varies != 0;
        w->lights.bounds |= w->lights.lights[i].medium != 0;
    }
}

static bool build(world *w, const kiln_scene *scene, const kiln_decoding *decoding, kiln_texture_filter filter,
                  uint32_t threads, const char *embree_config, kiln_report *report) {
    world_choose_space(w, scene);
    if (!world_build_materials(w, scene, decoding, filter, threads, report) ||
        !world_build_geometry(w, scene, threads, report) || !world_build_lights(w, scene, decoding, threads, report))
        return false;
    note_emission(w);
    return accel_create(w, threads, embree_config, report);
}

bool world_create(const kiln_scene *scene, const kiln_decoding *decoding, kiln_texture_filter filter, uint32_t threads,
                  const char *embree_config, world **result, kiln_report *report) {
    *result = NULL;
    world *w = calloc(1, sizeof *w);
    if (!w) return report_no_memory(report, "building the scene");
    if (!build(w, scene, decoding, filter, threads, embree_config, report)) {
        world_destroy(w);
        return false;
    }
    *result = w;
    return true;
}

void world_destroy(world *w) {
    if (!w) return;
    accel_destroy(w->accel);
    images_free(w->images, w->image_count);
    arena_free(&w->arena);
    free(w);
}
