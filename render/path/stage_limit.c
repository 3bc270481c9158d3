#include "render/path/flight.h"
#include "render/path/stages.h"

/* A probe hands over what it has found so far; from here on its radiance is what the limit cuts off. */
static void start_probe(batch *b, uint32_t i) {
    path_state *s = batch_state(b);
    batch_flush(b, i);
    s->slot[i] |= SLOT_BEYOND;
    s->lr[i] = s->lg[i] = s->lb[i] = 0.0f;
}

/* How far past the limit a path is: bounces off surfaces, or other steps, of which there may be more. */
static int32_t excess(const path_context *c, const batch *b, uint32_t i) {
    if (!HAS(c->effects, SOLIDS)) return (int32_t)(b->depth - c->max_depth);
    bool met = i < b->surfaces;
    int32_t events = (int32_t)(b->states[b->current].events[i] + (met ? b->scratch.hidden[i] : 0u));
    int32_t bounces = met ? (int32_t)b->depth - events - (int32_t)c->max_depth : -1;
    int32_t others = events - MEDIUM_EVENTS_MAX;
    return bounces > others ? bounces : others;
}

bool STAGE(limit)(const path_context *c, batch *b) {
    path_state *s = batch_state(b);
    bool ended = false;
    for (uint32_t i = 0; i < b->n; i++) {
        int32_t past = excess(c, b, i);
        if (past < 0) continue;
        bool probe = past < PROBE_DEPTHS && path_is_probe(s->seed[i], s->index[i]) &&
                     slot_index(s->slot[i]) != SLOT_NOWHERE;
        ended |= !probe;
        if (!probe) s->tr[i] = s->tg[i] = s->tb[i] = 0.0f;
        else if (!(s->slot[i] & SLOT_BEYOND)) start_probe(b, i);
    }
    return ended;
}
