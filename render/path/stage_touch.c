#include "render/path/stages.h"
#include "render/path/touch.h"

typedef struct visit { const world *world; const path_state *state; touch *touches; } visit;

static void add(void *user, uint32_t ray, const ray_crossing *c) {
    const visit *v = user;
    const path_state *s = v->state;
    touch_add(&v->touches[ray], v->world, v3(s->dx[ray], s->dy[ray], s->dz[ray]), c);
}

/* Lanes that met a solid, each with what was met, and the stretch of the ray about it. */
static uint32_t list_solids(const world *w, batch *b) {
    const path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    uint32_t count = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        h->beyond[i] = s->media[i];
        if (h->triangle[i] >= TRIANGLE_REFUSED || !w->materials[w->triangle_material[h->triangle[i]]].medium) continue;
        vec3 d = {s->dx[i], s->dy[i], s->dz[i]};
        ray_crossing met = {h->triangle[i], h->instance[i], h->t[i], h->u[i], h->v[i]};
        float about = touch_distance(w, d, met.triangle, met.instance);
        x->touches[i] = (touch){0};
        touch_add(&x->touches[i], w, d, &met);
        x->tnear[i] = fm_max(met.t - about, 0x1p-126f);
        x->tfar[i] = met.t + about;
        x->list[count++] = i;
    }
    return count;
}

void STAGE(touch)(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    uint32_t count = list_solids(w, b);
    ray_coverage coverage = {s->seed, s->index, sample_key(SAMPLE_COVERAGE, b->depth), c->independent};
    ray_lanes rays = {s->ox, s->oy, s->oz, s->dx, s->dy, s->dz, x->tnear, x->tfar, coverage, x->list, count,
                      false};
    visit v = {w, s, x->touches};
    trace_counts uncounted = {.tape = b->bounce_rays.tape}; /* a part of the trace before */
    accel_visit(w, &rays, add, &v, &uncounted);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = x->list[k];
        const touch *t = &x->touches[i];
        h->triangle[i] = t->shaded.triangle, h->instance[i] = t->shaded.instance;
        h->t[i] = t->shaded.t, h->u[i] = t->shaded.u, h->v[i] = t->shaded.v;
        h->beyond[i] = touch_beyond(t, s->media[i]);
    }
}
