#include "render/path/stages.h"

void STAGE(random)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    path_scratch *x = &b->scratch;
    uint32_t depth = b->depth;
    int independent = c->independent;
    if (c->samples_lights) {
        LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
            sample_point p = {s->index[i], s->seed[i]};
            vec2 place = sample_pair(independent, p, SAMPLE_LIGHT, depth);
            x->u_light_x[i] = place.x, x->u_light_y[i] = place.y;
        }
    }
    if (c->samples_lights && (c->light_tree || c->light_cdf || HAS(c->effects, ENVIRONMENT))) {
        LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
            sample_point p = {s->index[i], s->seed[i]};
            x->u_fine[i] = sample_pair(independent, p, SAMPLE_LIGHT_FINE, depth).x;
        }
    }
    LANE_LOOP (uint32_t i = 0; i < b->n; i++) {
        sample_point p = {s->index[i], s->seed[i]};
        vec2 direction = sample_pair(independent, p, SAMPLE_BSDF, depth);
        vec2 lobe = sample_pair(independent, p, SAMPLE_LOBE, depth);
        x->u_bsdf_x[i] = direction.x, x->u_bsdf_y[i] = direction.y;
        x->u_lobe[i] = lobe.x, x->u_roulette[i] = lobe.y;
    }
}
