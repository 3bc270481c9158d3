/* render/path/choice.h: with what probability a point's light sample would have found a light that a ray hit. */
#ifndef KILN_RENDER_PATH_CHOICE_H
#define KILN_RENDER_PATH_CHOICE_H

#include "render/light/tree.h"
#include "render/path/path.h"

/* Where a lane's path was last lit, if that is kept. */
static inline vantage path_vantage(const path_context *c, const path_state *s, uint32_t i) {
    if (!c->keeps_place) return (vantage){.far_share = 0};
    vec3 p = {s->from_x[i], s->from_y[i], s->from_z[i]};
    if (!c->light_tree) return (vantage){.p = p};
    return (vantage){p, {s->up_x[i], s->up_y[i], s->up_z[i]}, s->far_share[i]};
}

/* With which a light of the table is chosen for a point. */
static inline float path_light_probability(const path_context *c, uint32_t which, const vantage *from) {
    if (c->light_tree) {
        const light_table *t = &c->world->lights;
        if (which < t->near_count) return (1.0f - from->far_share) * tree_probability(c->light_tree, which, from);
        return from->far_share * (c->light_cdf ? distribution_probability(c->light_cdf, which - t->near_count) : 1.0f);
    }
    if (c->light_cdf) return distribution_probability(c->light_cdf, which);
    return c->samples_lights ? 1.0f : 0.0f;
}

#endif
