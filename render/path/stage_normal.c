#include "render/path/stages.h"
#include "render/path/surface.h"

static void apply_maps(path_scratch *x, uint32_t n) {
    LANE_LOOP (uint32_t i = 0; i < n; i++) {
        vec3 normal = surface_map(v3(x->nx[i], x->ny[i], x->nz[i]), v3(x->tan_x[i], x->tan_y[i], x->tan_z[i]),
                                  x->tan_w[i], v3(x->map_x[i], x->map_y[i], x->map_z[i]), x->front[i]);
        x->nx[i] = normal.x, x->ny[i] = normal.y, x->nz[i] = normal.z;
    }
}

void STAGE(normal)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    if (c->world->slots & 1u << SLOT_NORMAL) apply_maps(x, b->surfaces);
    LANE_LOOP (uint32_t i = 0; i < b->surfaces; i++) {
        vec3 wo = {-s->dx[i], -s->dy[i], -s->dz[i]};
        vec3 n = surface_face(v3(x->nx[i], x->ny[i], x->nz[i]), wo);
        x->nx[i] = n.x, x->ny[i] = n.y, x->nz[i] = n.z;
    }
}
