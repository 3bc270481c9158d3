#include "render/path/medium.h"
#include "render/path/stages.h"

void STAGE(absorb)(const path_context *c, batch *b) {
    const float *absorption = c->world->absorption;
    path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *around = b->scratch.list, n = b->surfaces;
    for (uint32_t i = 0; i < n; i++) around[i] = medium_top(s->media[i]);
    LANE_LOOP (uint32_t i = 0; i < n; i++) {
        vec3 left = medium_transmittance(absorption, around[i], h->t[i]);
        s->tr[i] *= left.x;
        s->tg[i] *= left.y;
        s->tb[i] *= left.z;
    }
}
