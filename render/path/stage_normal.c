#include "render/path/stages.h"
#include "render/path/surface.h"

static void apply_maps(path_scratch *x, uint32_t n) {
    LANE_LOOP (uint32_t i = 0; i < n; i++) {
        vec3 normal = surface_map(v3(x->nx[i], x->ny[i], x->nz[i]), v3(x->tan_x[i], x->tan_y[i], x->tan_z[i]),
                                  x->tan_w[i], v3(x->map_x[i], x->map_y[i], x->map_z[i]), x->front[i]);
        x->nx[i] = normal.x, x->ny[i] = normal.y, x->nz[i] = normal.z;
    }
}

/* Clear coats follow the interpolated normal, or a map of their own: before the surface's map bends it. */
static void face_clearcoats(const path_state *s, path_scratch *x, lane_range lanes) {
    LANE_LOOP (uint32_t i = lanes.first; i < lanes.end; i++) {
        vec3 n = surface_map(v3(x->nx[i], x->ny[i], x->nz[i]), v3(x->tan_x[i], x->tan_y[i], x->tan_z[i]), x->tan_w[i],
                             v3(x->coat_x[i], x->coat_y[i], x->coat_z[i]), x->front[i]);
        n = surface_face(n, v3(-s->dx[i], -s->dy[i], -s->dz[i]));
        x->coat_x[i] = n.x, x->coat_y[i] = n.y, x->coat_z[i] = n.z;
    }
}

/* Which way highlights stretch: after it has. */
static void find_directions(path_scratch *x, lane_range lanes) {
    LANE_LOOP (uint32_t i = lanes.first; i < lanes.end; i++) {
        vec3 a = surface_along(v3(x->nx[i], x->ny[i], x->nz[i]), v3(x->tan_x[i], x->tan_y[i], x->tan_z[i]), x->tan_w[i],
                               x->along_u[i], x->along_v[i], x->front[i]);
        x->along_x[i] = a.x, x->along_y[i] = a.y, x->along_z[i] = a.z;
    }
}

void STAGE(normal)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    face_clearcoats(s, x, b->kinds[KIND_COATED]);
    face_clearcoats(s, x, kinds_range(b, KIND_LAYERED, KIND_FILMED));
    if (HAS(c->effects, NORMAL_MAPS)) apply_maps(x, b->surfaces);
    LANE_LOOP (uint32_t i = 0; i < b->surfaces; i++) {
        vec3 wo = {-s->dx[i], -s->dy[i], -s->dz[i]};
        vec3 n = surface_face(v3(x->nx[i], x->ny[i], x->nz[i]), wo);
        x->nx[i] = n.x, x->ny[i] = n.y, x->nz[i] = n.z;
    }
    find_directions(x, b->kinds[KIND_COATED]);
    find_directions(x, kinds_range(b, KIND_LAYERED, KIND_FILMED));
}
