/* render/path/stage_choose.c: which light, for every lane.
 *
 * The choice takes its share of the place's first number and leaves the rest, so that lights that lie side by side, as the
 * triangles of a lamp do, are sampled as one stratified area. */
#include "render/path/choice.h"
#include "render/path/stages.h"

/* Lanes that go down a tree together, one level after the other: so that the caches can be told of the nodes that the
 * next level reads, and still have them when it does. */
enum { TOGETHER = 64 };

/* Leaves a light to each lane: its number and kind, its probability, the rest of the random number. */
static void put(const light_table *t, path_scratch *x, uint32_t i, uint32_t which, float probability, float rest) {
    x->u_light_x[i] = rest;
    x->probability[i] = probability;
    x->light[i] = which;
    x->light_kind[i] = (uint32_t)t->lights[which].kind;
}

static void choose_alike(const path_context *c, batch *b) {
    const light_table *t = &c->world->lights;
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->n; i++) {
        float rest = x->u_light_x[i];
        uint32_t k = 0;
        if (c->light_cdf) k = distribution_pick(c->light_cdf, c->light_guide, t->count, rest, x->u_fine[i], &rest);
        put(t, x, i, k, path_light_probability(c, k, NULL), rest);
    }
}

/* Where each lane is lit, until its path meets the next surface. Only surfaces that let nothing through have a side that
 * no light reaches. */
static void look_around(const path_context *c, batch *b) {
    path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t i = 0; i < b->n; i++)
        s->from_x[i] = x->above_x[i], s->from_y[i] = x->above_y[i], s->from_z[i] = x->above_z[i];
    if (!c->light_tree) return;
    for (uint32_t i = 0; i < b->n; i++) {
        bool sided = i < b->surfaces && !(c->world->materials[x->material[i]].flags & MATERIAL_TRANSMITS);
        float up = sided ? 1.0f : 0.0f;
        s->up_x[i] = up * x->nx[i], s->up_y[i] = up * x->ny[i], s->up_z[i] = up * x->nz[i];
    }
}

/* What is left of a lane's descent. */
typedef struct descent {
    tree_step step;
    uint32_t lane;
} descent;

/* Has it reached a light? Then that is its lane's. */
static bool arrives(const path_context *c, batch *b, const descent *d) {
    uint32_t which = d->step.child & TREE_INDEX;
    if (d->step.child & TREE_LEAF) {
        float rest = tree_rest(d->step.u, &b->scratch.u_fine[d->lane]);
        put(&c->world->lights, &b->scratch, d->lane, which, (1.0f - batch_state(b)->far_share[d->lane]) * d->step.p, rest);
        return true;
    }
    const char *next = (const char *)&c->light_tree->nodes[which];
    for (size_t line = 0; line < sizeof(light_node); line += 64) __builtin_prefetch(next + line);
    return false;
}

/* One step of each. Returns how many have another one before them. */
static uint32_t go_down(const path_context *c, batch *b, descent *descents, uint32_t count) {
    uint32_t left = 0;
    for (uint32_t k = 0; k < count; k++) {
        descent d = descents[k];
        vantage from = path_vantage(c, batch_state(b), d.lane);
        tree_go_down(c->light_tree, &from, &d.step);
        if (!arrives(c, b, &d)) descents[left++] = d;
    }
    return left;
}

/* A light without a place. */
static void choose_far(const path_context *c, batch *b, uint32_t i, const vantage *from, double u) {
    const light_table *t = &c->world->lights;
    path_scratch *x = &b->scratch;
    uint32_t k = t->near_count;
    float rest = tree_rest(u, &x->u_fine[i]);
    if (c->light_cdf)
        k += distribution_pick(c->light_cdf, c->light_guide, t->count - t->near_count, rest, x->u_fine[i], &rest);
    put(t, x, i, k, path_light_probability(c, k, from), rest);
}

static void choose_by_place(const path_context *c, batch *b, uint32_t first, uint32_t end) {
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    descent descents[TOGETHER];
    uint32_t count = 0;
    for (uint32_t i = first; i < end; i++) {
        vantage from = path_vantage(c, s, i);
        tree_start start = tree_enter(c->light_tree, &from, c->world->lights.far, x->u_light_x[i], x->u_fine[i]);
        s->far_share[i] = from.far_share = start.far_share;
        descent d = {start.step, i};
        if (start.is_far) choose_far(c, b, i, &from, d.step.u);
        else if (!arrives(c, b, &d)) descents[count++] = d;
    }
    while (count > 0) count = go_down(c, b, descents, count);
}

void STAGE(choose)(const path_context *c, batch *b) {
    if (c->keeps_place) look_around(c, b);
    if (!c->light_tree) {
        choose_alike(c, b);
        return;
    }
    for (uint32_t i = 0; i < b->n; i += TOGETHER)
        choose_by_place(c, b, i, i + TOGETHER < b->n ? i + TOGETHER : b->n);
}
