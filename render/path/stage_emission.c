#include "render/path/choice.h"
#include "render/path/estimate.h"
#include "render/path/stages.h"

/* The density with which a light sample would have found the point, left in light_pdf; single-sided emitters seen from
 * behind are dark. */
static void find_lights(const path_context *c, batch *b) {
    const world *w = c->world;
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->surfaces; i++) {
        uint32_t number = w->triangle_light ? w->triangle_light[h->triangle[i]] : LIGHT_NONE;
        uint32_t which = w->instances[h->instance[i]].light_base + number;
        bool shared = number != LIGHT_NONE && s->pdf[i] > 0.0f; /* else no light sample could have found it */
        x->light_pdf[i] = 0.0f;
        if (shared) {
            vantage from = path_vantage(c, s, i);
            float cosine = v3_dot(v3(x->gx[i], x->gy[i], x->gz[i]), v3(s->dx[i], s->dy[i], s->dz[i]));
            x->light_pdf[i] = path_light_probability(c, which, &from) *
                              light_triangle_pdf(&w->lights.lights[which], from.p, h->t[i], cosine);
        }
        const world_material *m = &w->materials[x->material[i]];
        bool shines = x->front[i] > 0.5f || m->flags & MATERIAL_TWO_SIDED;
        if (!shines) x->emit_r[i] = x->emit_g[i] = x->emit_b[i] = 0.0f;
    }
}

/* A clear coat dims what shines below it. */
static void dim(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    for (uint32_t i = 0; i < b->surfaces; i++) {
        if (!(c->world->materials[x->material[i]].clearcoat > 0.0f)) continue;
        vec3 n = {x->gx[i], x->gy[i], x->gz[i]}, d = {s->dx[i], s->dy[i], s->dz[i]};
        float through = clearcoat_dims(x->clearcoat[i] * x->near_layers[i], fabsf(v3_dot(n, d)));
        x->emit_r[i] *= through, x->emit_g[i] *= through, x->emit_b[i] *= through;
    }
}

void STAGE(emission)(const path_context *c, batch *b) {
    find_lights(c, b);
    if (HAS(c->effects, CLEARCOAT)) dim(c, b);
    path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    kiln_estimator estimator = estimate_hits_by(c->estimator, b->depth);
    LANE_LOOP (uint32_t i = 0; i < b->surfaces; i++) {
        float weight = estimate_hit_weight(estimator, s->pdf[i], x->light_pdf[i]);
        s->lr[i] += s->tr[i] * x->emit_r[i] * weight;
        s->lg[i] += s->tg[i] * x->emit_g[i] * weight;
        s->lb[i] += s->tb[i] * x->emit_b[i] * weight;
    }
}
