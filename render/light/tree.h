/* render/light/tree.h: choosing among many lights by what each can do for the point that is lit.
 *
 * A tree over the lights that have a place. A child of a node is a light, or a cluster of them that is known by bounds: a
 * sphere around it, a cone around its normals, the sum of its intensities. The choice goes down from the root, at each
 * node in proportion to the importance of the children: a bound-like estimate of the irradiance that they give (Conty
 * Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", section 3; Pharr, Jakob and
 * Humphreys 2023, "Physically Based Rendering", 12.6.3), which is 0 only for what cannot light the point. Nodes have
 * eight children, not two: they are weighed side by side in the lanes of a vector register, a choice among 100,000 lights
 * is six steps instead of seventeen, and each is made knowing more. */
#ifndef KILN_RENDER_LIGHT_TREE_H
#define KILN_RENDER_LIGHT_TREE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/fmath.h"
#include "render/light/table.h"

enum {
    TREE_WIDTH = 8,
    TREE_SLOT_BITS = 3,
    TREE_LEVELS = 20,          /* at most: so many slots fit a trail */
    TREE_LEAF = 1u << 31,      /* of light_node.child: it is a light */
    TREE_TWO_SIDED = 1u << 30, /* its normals count both ways */
    TREE_INDEX = TREE_TWO_SIDED - 1
};

#define TREE_NOWHERE UINT64_MAX /* the trail of a light that is not in the tree */

/* Structure of arrays; 384 bytes. */
typedef struct light_node {
    float x[TREE_WIDTH], y[TREE_WIDTH], z[TREE_WIDTH]; /* center of the sphere */
    float radius[TREE_WIDTH];                          /* > 0 */
    float ax[TREE_WIDTH], ay[TREE_WIDTH], az[TREE_WIDTH]; /* axis of the cone of normals, unit length */
    float cos_o[TREE_WIDTH], sin_o[TREE_WIDTH];        /* its half angle; π: they point everywhere */
    float cos_e[TREE_WIDTH];                           /* of the angle from a normal beyond which no light goes, less TREE_SLACK */
    float intensity[TREE_WIDTH];                       /* along the normals, of all in the tree 1; 0: no child */
    uint32_t child[TREE_WIDTH];                        /* index of a node, or of a light, and flags */
} light_node;

typedef struct light_tree {
    light_node *nodes; /* [0]: the root */
    uint32_t node_count;
    uint64_t *trails;  /* by light: the slots that lead to it, that of the root in the lowest bits */
} light_tree;

/* Where light arrives. */
typedef struct vantage {
    vec3 p, up;      /* up: the normal beneath which nothing arrives; 0: it may come from everywhere */
    float far_share; /* tree_far_share there */
} vantage;

#define TREE_LAST (1 - 0x1p-48) /* the last number before 1 that rounding leaves below */

/* What rounding may do to cosines and sines of angles that bounds are added to: √(1 − cos²) is off by 2⁻¹⁰·⁵ at most. */
#define TREE_SLACK 0x1p-10f

/* Of slot k: intensity · the most that its cosines can be · that of the point's / distance², no less than the radius.
 *
 * Some light of a sphere of radius r, whose normals lie in a cone of half angle θo, faces the point when the highest
 * of the planes that bound it does: distance · cos max(0, θw − θo) + r > 0, θw the angle between the axis and the way
 * to the point. The same sum over the distance, cut at 1, stands for the cosine; and so for the point's own, whose cone
 * is its normal; all_around is 2 where it has none, else TREE_SLACK. That takes two square roots where sums of angles take four, and serves as well. */
KERNEL float tree_importance(const light_node *n, int k, vantage v, float all_around) {
    vec3 d = v3_sub(v3(n->x[k], n->y[k], n->z[k]), v.p);
    float distance2 = v3_dot(d, d), radius = n->radius[k], radius2 = radius * radius;
    float inverse = 1.0f / sqrtf(fm_max(distance2, radius2)), size = radius * inverse;
    float along = -inverse * v3_dot(v3(n->ax[k], n->ay[k], n->az[k]), d), cos_i = inverse * v3_dot(v.up, d);
    float cos_w = n->child[k] & TREE_TWO_SIDED ? fabsf(along) : along, cos_o = n->cos_o[k];
    float sin_w = sqrtf(fm_max(1.0f - cos_w * cos_w, 0.0f));
    float cosine = cos_w > cos_o ? 1.0f : cos_w * cos_o + sin_w * n->sin_o[k];
    float leaves = fm_clamp(cosine + size, TREE_SLACK, 1.0f), arrives = fm_min(cos_i + size + all_around, 1.0f);
    /* cos(a − b) − cos a = 2 sin(a − b/2) sin(b/2) < 1.42 sin b, for sin b = size. */
    int shines = (cosine + 1.42f * size > n->cos_e[k]) | (distance2 <= radius2);
    int comes = shines & (arrives > 0.0f) & (n->intensity[k] > 0.0f);
    float importance = n->intensity[k] * leaves * arrives * (inverse * inverse);
    return comes ? fm_max(importance, 0x1p-126f) : 0.0f;
}

/* What the slots of a node are worth, and sums of two, four and all: slots k and k + 4 make a pair, pairs k and k + 2 a
 * half. */
typedef struct tree_weights { float one[TREE_WIDTH], two[TREE_WIDTH / 2], four[TREE_WIDTH / 4], all; } tree_weights;

KERNEL tree_weights tree_weigh(const light_node *n, vantage v) {
    float all_around = v3_dot(v.up, v.up) > 0.5f ? TREE_SLACK : 2.0f;
    tree_weights w;
    _Pragma("GCC ivdep") for (int k = 0; k < TREE_WIDTH; k++) w.one[k] = tree_importance(n, k, v, all_around);
    for (int k = 0; k < TREE_WIDTH / 2; k++) w.two[k] = w.one[k] + w.one[k + TREE_WIDTH / 2];
    for (int k = 0; k < TREE_WIDTH / 4; k++) w.four[k] = w.two[k] + w.two[k + TREE_WIDTH / 4];
    w.all = w.four[0] + w.four[1];
    return w;
}

/* The probability of a way on by a slot of weight > 0. */
KERNEL float tree_share(float p, const tree_weights *w, uint32_t slot) { return fm_max(p * (w->one[slot] / w->all), 0x1p-126f); }

/* Does x lie past the first of two? Then what lies before is taken off it. Rounding leads to nothing that weighs 0. */
KERNEL uint32_t tree_passes(double *x, float first, float second) {
    uint32_t past = (*x >= (double)first) & (second > 0.0f);
    *x -= past ? (double)first : 0.0;
    return past;
}

/* A slot for *u in [0, TREE_LAST], which becomes the place within it, of a sum > 0. */
KERNEL uint32_t tree_pick(const tree_weights *w, double *u) {
    double x = *u * (double)w->all;
    uint32_t slot = tree_passes(&x, w->four[0], w->four[1]);
    slot += 2 * tree_passes(&x, w->two[slot], w->two[slot + 2]);
    slot += 4 * tree_passes(&x, w->one[slot], w->one[slot + 4]);
    double within = x / (double)w->one[slot];
    *u = within < TREE_LAST ? within : TREE_LAST;
    return slot;
}

/* A choice on its way down: what is left of the random number, the probability of the way, where it has led. */
typedef struct tree_step {
    double u;
    float p;
    uint32_t child;
} tree_step;

/* By the weights of a node. Where none of its children can light the point, though their common bounds said that some
 * might, the choice ends at light 0 with probability 0. */
KERNEL void tree_descend(const light_node *n, const tree_weights *w, tree_step *s) {
    if (!(w->all > 0.0f)) {
        *s = (tree_step){.child = TREE_LEAF};
        return;
    }
    uint32_t slot = tree_pick(w, &s->u);
    s->p = tree_share(s->p, w, slot);
    s->child = n->child[slot];
}
static inline void tree_go_down(const light_tree *t, const vantage *from, tree_step *s) {
    const light_node *n = &t->nodes[s->child & TREE_INDEX];
    tree_weights w = tree_weigh(n, *from);
    tree_descend(n, &w, s);
}

/* The probability of a light that has a place among those that have one: the same products. */
static inline float tree_probability(const light_tree *t, uint32_t which, const vantage *from) {
    uint64_t trail = t->trails[which];
    float p = trail == TREE_NOWHERE ? 0.0f : 1.0f;
    for (uint32_t child = 0; p > 0.0f && !(child & TREE_LEAF); trail >>= TREE_SLOT_BITS) {
        const light_node *n = &t->nodes[child & TREE_INDEX];
        tree_weights w = tree_weigh(n, *from);
        uint32_t slot = (uint32_t)trail & (TREE_WIDTH - 1);
        p = w.one[slot] > 0.0f ? tree_share(p, &w, slot) : 0.0f;
        child = n->child[slot];
    }
    return p;
}

/* The share of the choices that goes to the lights without a place: half of it by the irradiance that they may give
 * against what the tree may give here, which both may be in shadow, and so half of it alike. */
KERNEL float tree_far_share(float near, float far) {
    float shared = far > 0.0f ? 0.25f + 0.5f * (far / (far + near)) : 0.0f;
    return near > 0.0f ? shared : far > 0.0f ? 1.0f : 0.0f;
}

/* The first choice: a light without a place, or the first step down. */
typedef struct tree_start {
    tree_step step; /* is_far: u alone */
    float far_share;
    bool is_far;
} tree_start;

/* u in [0, 1), a multiple of 2⁻²⁴, and fine, its further digits; far: light_table.far. */
static inline tree_start tree_enter(const light_tree *t, const vantage *from, float far, float u, float fine) {
    tree_weights w = tree_weigh(&t->nodes[0], *from);
    double x = (double)u + (double)fine * 0x1p-24;
    tree_start r = {.step = {.p = 1.0f}, .far_share = tree_far_share(w.all, far)};
    double share = (double)r.far_share;
    r.is_far = x < share;
    r.step.u = r.is_far ? x / share : fmin((x - share) / (1 - share), TREE_LAST); /* share = 1 leaves no other */
    if (!r.is_far) tree_descend(&t->nodes[0], &w, &r.step);
    return r;
}

/* A number that is left over as one of 24 bits, and *fine, its further digits. */
static inline float tree_rest(double u, float *fine) {
    double scaled = u * 0x1p24;
    int32_t whole = (int32_t)scaled;
    *fine = fm_min((float)(scaled - (double)whole), 0x1.fffffep-1f);
    return (float)whole * 0x1p-24f;
}

/* Builds a tree over the lights of positive intensity, of which there is one at least; count ≤ TREE_INDEX. Intensities
 * are along the normals, in any unit. NULL: out of memory. */
light_tree *light_tree_build(kiln_arena *, const light *lights, const float *intensity, uint32_t count);

#endif
