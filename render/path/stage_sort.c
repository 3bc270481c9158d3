#include "render/path/stages.h"

/* A lane that only fills up a group of sixteen. */
#define FILLING (1u << 31)

static bool is_alive(const path_state *s, uint32_t i) { return s->tr[i] > 0.0f || s->tg[i] > 0.0f || s->tb[i] > 0.0f; }

/* Moves the lanes that order names, with their hits, to the other half of the batch. */
static void move(uint64_t effects, batch *b, uint32_t count, bool with_hits) {
    const path_state *from = &b->states[b->current];
    path_state *to = &b->states[1 - b->current];
    const path_hit *from_hit = &b->hits[b->current];
    path_hit *to_hit = &b->hits[1 - b->current];
    const uint32_t *order = b->scratch.order;
#define MOVE_STATE(type, name) LANE_LOOP (uint32_t j = 0; j < count; j++) to->name[j] = from->name[order[j] & ~FILLING];
#define MOVE_HIT(type, name) \
    LANE_LOOP (uint32_t j = 0; j < count; j++) to_hit->name[j] = from_hit->name[order[j] & ~FILLING];
    PATH_STATE(MOVE_STATE)
    if (HAS(effects, SOLIDS)) {
        PATH_MEDIA(MOVE_STATE)
        PATH_EVENTS(MOVE_STATE)
    }
    if (HAS(effects, TEXTURE_FILTERING)) {
        PATH_CONE(MOVE_STATE)
    }
    if (with_hits) {
        PATH_HIT(MOVE_HIT)
    }
    if (with_hits && HAS(effects, NESTED_MEDIA)) {
        PATH_TOUCH(MOVE_HIT)
    }
    for (uint32_t j = 0; j < count; j++) {
        if (!(order[j] & FILLING)) continue;
        to->slot[j] = SLOT_NOWHERE;
        to->tr[j] = to->tg[j] = to->tb[j] = 0.0f;
    }
    b->current = 1 - b->current;
    b->n = count;
}

static uint32_t fill_group(uint32_t *order, uint32_t count) {
    for (; count % LANE_GROUP; count++) order[count] = order[count - 1] | FILLING;
    return count;
}

void STAGE(sort)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *order = b->scratch.order, *kind = b->scratch.list, count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        bool goes_on = h->triangle[i] < TRIANGLE_REFUSED && is_alive(s, i);
        kind[i] = goes_on ? w->materials[w->triangle_material[h->triangle[i]]].kind : KIND_COUNT;
        if (goes_on && h->u[i] == HIT_SCATTERED) kind[i] = KIND_MEDIUM;
        if (goes_on) continue;
        batch_flush(b, i);
        if (h->triangle[i] == TRIANGLE_REFUSED) b->out.refused[slot_index(s->slot[i])] = 1;
    }
    for (uint32_t k = 0; k < KIND_COUNT; k++) {
        b->kinds[k].first = count;
        for (uint32_t i = 0; w->kinds & 1u << k && i < b->n; i++)
            if (kind[i] == k) order[count++] = i;
        b->kinds[k].end = count = fill_group(order, count);
    }
    b->surfaces = b->kinds[KIND_MEDIUM].first;
    move(c->effects, b, count, true);
}

void STAGE(close)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    uint32_t *order = b->scratch.order, count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        if (is_alive(s, i)) order[count++] = i;
        else batch_flush(b, i);
    }
    move(c->effects, b, fill_group(order, count), false);
}
