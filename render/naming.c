/* The names of the scene's things, as mattes call them. */
#include "render/context.h"
#include "scene/scene.h"

static const char *name_of(const kiln_scene *s, kiln_arena *arena, kiln_matte matte, uint32_t handle) {
    const kiln_instance *instance = handle && matte != KILN_MATTE_MATERIAL ? scene_instance(s, handle) : NULL;
    switch (matte) {
    case KILN_MATTE_MATERIAL:
        return handle ? scene_name(arena, scene_material(s, handle)->name, "material ", handle) : "default";
    case KILN_MATTE_ASSET:
        if (instance && *instance->asset) return instance->asset;
        break;
    case KILN_MATTE_OBJECT:
    case KILN_MATTE_COUNT: break;
    }
    return instance ? scene_name(arena, instance->name, "object ", handle) : ""; /* no instance has handle 0 */
}

static bool name_all(const kiln_scene *s, kiln_film *film, kiln_matte matte, kiln_report *report) {
    kiln_arena arena = {0};
    uint32_t count = 1 + (matte == KILN_MATTE_MATERIAL ? s->material_count : s->instance_count);
    const char **names = ARENA_ARRAY(&arena, const char *, count);
    bool done = names != NULL;
    for (uint32_t i = 0; done && i < count; i++) done = (names[i] = name_of(s, &arena, matte, i)) != NULL;
    done = done ? film_set_names(film, matte, names, count, report) : report_no_memory(report, "naming mattes");
    arena_free(&arena);
    return done;
}

bool context_name_mattes(const kiln_renderer *r, kiln_film *film, kiln_report *report) {
    bool done = true;
    for (int m = 0; done && m < KILN_MATTE_COUNT; m++)
        if (film->desc.mattes >> m & 1) done = name_all(r->scene, film, (kiln_matte)m, report);
    return done;
}
