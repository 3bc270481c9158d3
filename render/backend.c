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

static size_t image_bytes_of(const world_image *i) {
    static const size_t bytes[] = {
        [KILN_PIXELS_U8] = 1, [KILN_PIXELS_U16] = sizeof(float), [KILN_PIXELS_F32] = sizeof(float)};
    size_t values = 4 * (size_t)i->width * i->height;
    return (i->codes ? values * bytes[i->format] : 0) + (i->srgb ? values * sizeof(float) : 0);
}

kiln_renderer_memory kiln_renderer_describe_memory(const kiln_renderer *r) {
    const world *w = r->world;
    kiln_renderer_memory m = {.acceleration = accel_bytes(w->accel), .scene = w->arena.bytes};
    for (uint32_t i = 0; i < w->image_count; i++) m.textures += image_bytes_of(&w->images[i]);
    return m;
}
