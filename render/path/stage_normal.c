#include "render/path/stages.h"
#include "render/path/surface.h"

/* The tangent-space normal in render space: x T + y B + z N with N of unit length, T orthogonal to it and
 * B = w N × T (glTF 2.0, 3.7.2.1). A lane without a map has x = y = 0. */
static void apply_maps(path_scratch *x, uint32_t n) {
    LANE_LOOP (uint32_t i = 0; i < n; i++) {
        vec3 normal = {x->nx[i], x->ny[i], x->nz[i]}, t = {x->tan_x[i], x->tan_y[i], x->tan_z[i]};
        int mapped = (x->map_x[i] != 0.0f) | (x->map_y[i] != 0.0f);
        /* Seen from behind, the frame is turned over with its normal; handedness must stay the front's. */
        float side = x->front[i] > 0.5f ? 1.0f : -1.0f;
        t = v3_madd(t, -v3_dot(t, normal), normal);
        float length2 = v3_dot(t, t);
        int usable = mapped & (length2 > 1e-12f);
        t = v3_scale(t, 1.0f / sqrtf(usable ? length2 : 1.0f));
        vec3 bitangent = v3_scale(v3_cross(normal, t), x->tan_w[i] * side);
        vec3 bent = v3_madd(v3_madd(v3_scale(normal, x->map_z[i]), x->map_x[i] * side, t), x->map_y[i] * side, bitangent);
        float bent2 = v3_dot(bent, bent);
        usable = usable & (bent2 > 1e-12f);
        bent = v3_scale(bent, 1.0f / sqrtf(usable ? bent2 : 1.0f));
        vec3 r = v3_select(usable, bent, normal);
        x->nx[i] = r.x, x->ny[i] = r.y, x->nz[i] = r.z;
    }
}

void STAGE(normal)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    if (c->world->slots & 1u << SLOT_NORMAL) apply_maps(x, b->n);
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        vec3 wo = {-s->dx[i], -s->dy[i], -s->dz[i]};
        vec3 n = surface_face(v3(x->nx[i], x->ny[i], x->nz[i]), wo);
        x->nx[i] = n.x, x->ny[i] = n.y, x->nz[i] = n.z;
    }
}
