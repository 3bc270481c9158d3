#include "render/path/stages.h"
#include "render/world/lookup.h"

/* Layers of culled surfaces that a camera ray looks through before it gives up: more than any asset stacks. */
enum { CULLED_LAYERS = 1024 };

static bool is_culled(const world *w, const path_state *s, const path_hit *h, uint32_t i) {
    if (h->triangle[i] >= TRIANGLE_REFUSED) return false;
    const world_material *m = &w->materials[w->triangle_material[h->triangle[i]]];
    if (m->flags & MATERIAL_TWO_SIDED) return false;
    vec3 d = v3(s->dx[i], s->dy[i], s->dz[i]);
    return v3_dot(lookup_facing(w, h->triangle[i], h->instance[i]), d) > 0.0f;
}

/* Rays of the camera go on behind what they see from behind. */
static void look_through(const path_context *c, batch *b, ray_lanes *rays) {
    path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    uint32_t count = b->n;
    for (int layer = 0; count && layer < CULLED_LAYERS; layer++) {
        uint32_t kept = 0;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t i = layer ? x->list[k] : k;
            if (!is_culled(c->world, s, h, i)) continue;
            x->tnear[i] = fm_next_up(h->t[i]);
            x->list[kept++] = i;
        }
        count = kept;
        rays->lanes = x->list;
        rays->coherent = false;
        rays->count = count;
        if (count) accel_closest(c->world, rays, h->t, h->u, h->v, h->triangle, h->instance, &b->camera_rays);
    }
}

void STAGE(trace)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    bool first = b->depth == 0;
    ray_coverage coverage = {s->seed, s->index, sample_key(SAMPLE_COVERAGE, b->depth), c->independent};
    ray_lanes rays = {s->ox, s->oy, s->oz, s->dx, s->dy, s->dz, first ? x->tnear : NULL, first ? x->tfar : NULL,
                      coverage, NULL, b->n, first};
    accel_closest(c->world, &rays, h->t, h->u, h->v, h->triangle, h->instance, first ? &b->camera_rays : &b->bounce_rays);
    if (first && HAS(c->effects, CULLING)) look_through(c, b, &rays);
}
