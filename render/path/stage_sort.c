#include "render/path/stages.h"

/* A lane that only fills up a group of sixteen. */
#define FILLING (1u << 31)

static bool is_alive(const path_state *s, uint32_t i) {
    return (s->tr[i] > 0.0f) | (s->tg[i] > 0.0f) | (s->tb[i] > 0.0f);
}

/* So many lanes, whole groups, are where order has them. */
static uint32_t in_place(const uint32_t *order, uint32_t count) {
    uint32_t j = 0;
    while (j < count && order[j] == j) j++;
    return j / LANE_GROUP * LANE_GROUP;
}

/* Moves the lanes that order names, with their hits: within the arrays where order is ascending, for then no lane is
 * overwritten before it is read, and the first may stay where they are; else to the other half of the batch. */
static void move(const path_context *c, batch *b, uint32_t count, bool ascending, bool with_hits) {
    const uint64_t effects = c->effects;
    uint32_t half = ascending ? b->current : 1 - b->current;
    const path_state *from = &b->states[b->current];
    path_state *to = &b->states[half];
    const path_hit *from_hit = &b->hits[b->current];
    path_hit *to_hit = &b->hits[half];
    const uint32_t *order = b->scratch.order;
    uint32_t first = ascending ? in_place(order, count) : 0;
#define MOVE_STATE(type, name) \
    LANE_LOOP (uint32_t j = first; j < count; j++) to->name[j] = from->name[order[j] & ~FILLING];
#define MOVE_HIT(type, name) \
    LANE_LOOP (uint32_t j = first; j < count; j++) to_hit->name[j] = from_hit->name[order[j] & ~FILLING];
    PATH_STATE(MOVE_STATE)
    if (HAS(effects, SOLIDS)) {
        PATH_MEDIA(MOVE_STATE)
        PATH_EVENTS(MOVE_STATE)
    }
    if (HAS(effects, TEXTURE_FILTERING)) {
        PATH_CONE(MOVE_STATE)
    }
    if (c->keeps_place) {
        PATH_PLACE(MOVE_STATE)
    }
    if (c->light_tree) {
        PATH_VANTAGE(MOVE_STATE)
    }
    if (with_hits) {
        PATH_HIT(MOVE_HIT)
    }
    if (with_hits && HAS(effects, NESTED_MEDIA)) {
        PATH_TOUCH(MOVE_HIT)
    }
    for (uint32_t j = first; j < count; j++) {
        if (!(order[j] & FILLING)) continue;
        to->slot[j] = SLOT_NOWHERE;
        to->tr[j] = to->tg[j] = to->tb[j] = 0.0f;
    }
    b->current = half;
    b->n = count;
}

static uint32_t fill_group(uint32_t *order, uint32_t count) {
    for (; count % LANE_GROUP; count++) order[count] = order[count - 1] | FILLING;
    return count;
}

/* Their radiance is handed over. */
static void end(batch *b, const uint32_t *lanes, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) batch_flush(b, lanes[k]);
}

/* Lists that grow by 0 or 1 instead of branches: which paths end is anybody's guess, the processor's too. */
static uint32_t list_by_kind(const world *w, batch *b) {
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *order = b->scratch.order, *kind = b->scratch.list, count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        bool goes_on = (h->triangle[i] < TRIANGLE_REFUSED) & is_alive(s, i);
        kind[i] = goes_on ? w->materials[w->triangle_material[h->triangle[i]]].kind : KIND_COUNT;
        if (goes_on && h->u[i] == HIT_SCATTERED) kind[i] = KIND_MEDIUM;
    }
    for (uint32_t k = 0; k < KIND_COUNT; k++) {
        b->kinds[k].first = count;
        for (uint32_t i = 0; w->kinds & 1u << k && i < b->n; i++) {
            order[count] = i;
            count += kind[i] == k;
        }
        b->kinds[k].end = count = fill_group(order, count);
    }
    return count;
}

/* The same where all materials are of one kind. */
static uint32_t list_of_kind(material_kind only, batch *b) {
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *order = b->scratch.order, count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        order[count] = i;
        count += (h->triangle[i] < TRIANGLE_REFUSED) & is_alive(s, i);
    }
    count = fill_group(order, count);
    for (uint32_t k = 0; k < KIND_COUNT; k++) b->kinds[k] = (lane_range){k > only ? count : 0, k < only ? 0 : count};
    return count;
}

void STAGE(sort)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *ended = b->scratch.list, count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        ended[count] = i;
        count += (h->triangle[i] >= TRIANGLE_REFUSED) | !is_alive(s, i);
    }
    end(b, ended, count);
    for (uint32_t k = 0; k < count; k++)
        if (h->triangle[ended[k]] == TRIANGLE_REFUSED) b->out.refused[slot_index(s->slot[ended[k]])] = 1;
    bool alike = !(w->kinds & (w->kinds - 1));
    count = alike ? list_of_kind((material_kind)__builtin_ctz(w->kinds | 1u << KIND_COUNT), b) : list_by_kind(w, b);
    b->surfaces = b->kinds[KIND_MEDIUM].first;
    move(c, b, count, alike, true);
}

void STAGE(close)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    uint32_t *order = b->scratch.order, *ended = b->scratch.list, alive = 0, dead = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        bool goes_on = is_alive(s, i);
        order[alive] = ended[dead] = i;
        alive += goes_on;
        dead += !goes_on;
    }
    end(b, ended, dead);
    move(c, b, fill_group(order, alive), true, false);
}
