#include "render/light/light.h"
#include "render/path/choice.h"
#include "render/path/estimate.h"
#include "render/path/stages.h"

/* Lanes ahead that the caches are told of. */
enum { AHEAD_TEXELS = 12 };

static void add(path_state *s, uint32_t i, vec3 radiance) {
    s->lr[i] += s->tr[i] * radiance.x;
    s->lg[i] += s->tg[i] * radiance.y;
    s->lb[i] += s->tb[i] * radiance.z;
}

/* Suns of a visible size: their disk is seen by every ray that leaves the scene into it. */
static void add_suns(const path_context *c, batch *b, uint32_t i) {
    const light_table *t = &c->world->lights;
    path_state *s = batch_state(b);
    vec3 d = {s->dx[i], s->dy[i], s->dz[i]};
    kiln_estimator estimator = estimate_hits_by(c->estimator, b->depth);
    for (uint32_t k = 0; k < t->distant_count; k++) {
        const light *l = &t->lights[t->distant[k]];
        vec3 off = v3_add(d, l->axis); /* 1 − cos = |d − toward|²/2: exact for small disks */
        if (0.5f * v3_dot(off, off) > l->one_minus_cos) continue;
        vantage from = path_vantage(c, s, i);
        float probability = path_light_probability(c, t->distant[k], &from);
        float light_pdf = probability * light_distant_pdf(l->one_minus_cos);
        add(s, i, v3_scale(l->radiance, estimate_hit_weight(estimator, s->pdf[i], light_pdf)));
        if (c->parts) STAGE(part_found)(c, b, i, c->parts->of_light[l->owner]);
    }
}

static void add_environment(const path_context *c, batch *b, uint32_t count) {
    const environment *e = &c->world->lights.environment;
    path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    LANE_LOOP (uint32_t k = 0; k < count; k++) {
        uint32_t i = x->list[k];
        vec2 place = environment_place(v3(s->dx[i], s->dy[i], s->dz[i]));
        x->tu[k] = place.x;
        x->tv[k] = place.y;
    }
    kiln_estimator estimator = estimate_hits_by(c->estimator, b->depth);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = x->list[k], ahead = k + AHEAD_TEXELS;
        vantage from = path_vantage(c, s, i);
        float probability = path_light_probability(c, e->light, &from);
        if (ahead < count) environment_prefetch_place(e, (vec2){x->tu[ahead], x->tv[ahead]});
        environment_value v = environment_look_up(e, (vec2){x->tu[k], x->tv[k]});
        float weight = estimate_hit_weight(estimator, s->pdf[i], probability * v.pdf);
        add(s, i, v3_scale(v.radiance, weight));
    }
}

/* What a camera ray that meets nothing shows. */
static void show_background(const path_context *c, batch *b, uint32_t count) {
    path_state *s = batch_state(b);
    if (c->background != KILN_BACKGROUND_COLOR) return;
    for (uint32_t k = 0; k < count; k++) add(s, b->scratch.list[k], c->background_color);
}

/* All that is not a sun counts as the environment's. */
static void record_environment(const path_context *c, batch *b, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) STAGE(part_found)(c, b, b->scratch.list[k], c->parts->of_environment);
}

void STAGE(escape)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    uint32_t *list = b->scratch.list, count = 0;
    bool first = b->depth == 0, surrounded = !first || c->background == KILN_BACKGROUND_ENVIRONMENT;
    for (uint32_t i = 0; first && i < b->n; i++)
        b->out.alpha[slot_index(s->slot[i])] = h->triangle[i] < TRIANGLE_REFUSED ? 1.0f : 0.0f;
    for (uint32_t i = 0; i < b->n; i++)
        if (h->triangle[i] == TRIANGLE_NONE) list[count++] = i;
    if (first) show_background(c, b, count);
    if (surrounded && c->world->lights.environment.present) add_environment(c, b, count);
    if (c->parts) record_environment(c, b, count);
    for (uint32_t k = 0; surrounded && c->world->lights.distant_count && k < count; k++) add_suns(c, b, list[k]);
}
