#include "render/path/stages.h"

/* Lanes ahead that the caches are told of. */
enum { AHEAD_INDICES = 24, AHEAD_VERTICES = 12 };

static void prefetch(const world *w, const path_hit *h, uint32_t i, uint32_t n) {
    if (i + AHEAD_INDICES < n) __builtin_prefetch(w->triangles + 3 * (size_t)h->triangle[i + AHEAD_INDICES]);
    if (i + AHEAD_VERTICES >= n) return;
    const uint32_t *v = w->triangles + 3 * (size_t)h->triangle[i + AHEAD_VERTICES];
    for (int k = 0; k < 3; k++) __builtin_prefetch(&w->vertices[v[k]]);
}

/* Corners of a prototype's triangle become render space's. */
static void place(const world_instance *copy, path_scratch *x, uint32_t i) {
#define PLACE(p, as) \
    { vec3 q = world_instance_##as(copy, v3(x->p##x[i], x->p##y[i], x->p##z[i])); \
      x->p##x[i] = q.x, x->p##y[i] = q.y, x->p##z[i] = q.z; }
    PLACE(p0, point) PLACE(p1, point) PLACE(p2, point)
    PLACE(n0, normal) PLACE(n1, normal) PLACE(n2, normal)
#undef PLACE
}

void STAGE(fetch)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->surfaces; i++) {
        prefetch(w, h, i, b->surfaces);
        const uint32_t *v = w->triangles + 3 * (size_t)h->triangle[i];
        const world_vertex *a = &w->vertices[v[0]], *p = &w->vertices[v[1]], *q = &w->vertices[v[2]];
        x->p0x[i] = a->p[0], x->p0y[i] = a->p[1], x->p0z[i] = a->p[2];
        x->p1x[i] = p->p[0], x->p1y[i] = p->p[1], x->p1z[i] = p->p[2];
        x->p2x[i] = q->p[0], x->p2y[i] = q->p[1], x->p2z[i] = q->p[2];
        x->n0x[i] = a->n[0], x->n0y[i] = a->n[1], x->n0z[i] = a->n[2];
        x->n1x[i] = p->n[0], x->n1y[i] = p->n[1], x->n1z[i] = p->n[2];
        x->n2x[i] = q->n[0], x->n2y[i] = q->n[1], x->n2z[i] = q->n[2];
        x->s0[i] = a->uv[0], x->t0[i] = a->uv[1];
        x->s1[i] = p->uv[0], x->t1[i] = p->uv[1];
        x->s2[i] = q->uv[0], x->t2[i] = q->uv[1];
        x->material[i] = w->triangle_material[h->triangle[i]];
        const world_instance *copy = &w->instances[h->instance[i]];
        x->side[i] = copy->side;
        x->magnitude[i] = copy->magnitude;
        if (h->instance[i]) place(copy, x, i);
    }
}
