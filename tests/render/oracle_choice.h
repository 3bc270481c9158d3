/* tests/render/oracle_choice.h: the oracle's choice of a light: one lane from top to bottom. */
#ifndef KILN_TESTS_RENDER_ORACLE_CHOICE_H
#define KILN_TESTS_RENDER_ORACLE_CHOICE_H

#include "render/path/choice.h"

/* A light for a point, and what is left of the random number. */
static inline uint32_t choose_light(const path_context *c, vantage *from, float *u, float *fine, float *probability) {
    const light_table *t = &c->world->lights;
    uint32_t first = 0, k = 0;
    if (c->light_tree) {
        tree_start start = tree_enter(c->light_tree, from, t->far, *u, *fine);
        from->far_share = start.far_share;
        while (!start.is_far && !(start.step.child & TREE_LEAF)) tree_go_down(c->light_tree, from, &start.step);
        *u = tree_rest(start.step.u, fine);
        *probability = (1.0f - start.far_share) * start.step.p;
        if (!start.is_far) return start.step.child & TREE_INDEX;
        first = t->near_count;
    }
    if (c->light_cdf) k = distribution_pick(c->light_cdf, c->light_guide, t->count - first, *u, *fine, u);
    *probability = path_light_probability(c, first + k, from);
    return first + k;
}

#endif
