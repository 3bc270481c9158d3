#include "render/path/stages.h"

/* A probe hands over what it has found so far; from here on its radiance is what the limit cuts off. */
static void start_probe(batch *b, uint32_t i) {
    path_state *s = batch_state(b);
    batch_flush(b, i);
    s->slot[i] |= SLOT_BEYOND;
    s->lr[i] = s->lg[i] = s->lb[i] = 0.0f;
}

void STAGE(limit)(const path_context *c, batch *b) {
    path_state *s = batch_state(b);
    bool probes_end = b->depth >= c->max_depth + PROBE_DEPTHS;
    for (uint32_t i = 0; i < b->n; i++) {
        bool probe = !probes_end && path_is_probe(s->seed[i], s->index[i]) && slot_index(s->slot[i]) != SLOT_NOWHERE;
        if (!probe) s->tr[i] = s->tg[i] = s->tb[i] = 0.0f;
        else if (!(s->slot[i] & SLOT_BEYOND)) start_probe(b, i);
    }
}
