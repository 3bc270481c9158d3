#include "render/path/medium.h"
#include "render/path/stages.h"

void STAGE(absorb)(const path_context *c, batch *b) {
    const float *absorption = c->world->media;
    path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *innermost = b->scratch.list, n = b->n;
    for (uint32_t i = 0; i < n; i++) innermost[i] = (uint32_t)(s->media[i] & 0xffffu);
    LANE_LOOP (uint32_t i = 0; i < n; i++) {
        vec3 left = medium_transmittance(absorption, innermost[i], h->t[i]);
        s->tr[i] *= left.x;
        s->tg[i] *= left.y;
        s->tb[i] *= left.z;
    }
}
