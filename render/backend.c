/* What a renderer runs on, and what it takes. */
#include <string.h>

#include "render/accel/accel.h"
#include "render/context.h"
#include "render/world/images.h"

_Static_assert(sizeof((kiln_backend){{0}, 0}.embree) >= EMBREE_VERSION_MAX, "room for the version");

kiln_backend kiln_render_backend(void) {
    kiln_backend b = {.isa = "none"};
    embree_version(b.embree);
    (void)path_choose_tracer(NULL, &b.isa);
    return b;
}

kiln_renderer_memory kiln_renderer_describe_memory(const kiln_renderer *r) {
    const world *w = r->world;
    kiln_renderer_memory m = {.acceleration = accel_bytes(w->accel), .scene = w->arena.bytes};
    for (uint32_t i = 0; i < w->image_count; i++) m.textures += w->images[i].bytes;
    return m;
}
