#include "render/path/medium.h"
#include "render/path/stages.h"

void STAGE(absorb)(const path_context *c, batch *b) {
    const float *absorption = c->world->media;
    path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *innermost = b->scratch.list;
    for (uint32_t i = 0; i < b->n; i++) innermost[i] = (uint32_t)(s->media[i] & 0xffffu);
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        const float *a = absorption + 3 * (int32_t)innermost[i]; /* signed: gathers want it */
        vec3 left = medium_transmittance(a, h->t[i]);
        s->tr[i] *= left.x;
        s->tg[i] *= left.y;
        s->tb[i] *= left.z;
    }
}
