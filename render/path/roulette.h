/* render/path/roulette.h: which paths go on. Scalar kernels.
 *
 * Surviving with probability p and dividing by p keeps the expectation. FIXED takes the same p at every bounce.
 * THROUGHPUT takes the largest channel T of the throughput, which is the product over the bounces so far of
 * f cos/(pdf p_i); bounces under the minimum depth are guaranteed, p_i = 1. That brings every
 * survivor back to T = 1; AUTO, 1.5 √T after one guaranteed bounce, leaves part of the loss in the weight and spares
 * bright surfaces, which is more efficient (measured: docs/estimator.md). Radiance that refraction has squeezed into a
 * denser medium (÷ η²) will be released again and counts in full. */
#ifndef KILN_RENDER_PATH_ROULETTE_H
#define KILN_RENDER_PATH_ROULETTE_H

#include "base/fmath.h"
#include "render/path/path.h"

/* 0.99: two mirrors facing each other absorb nothing; a path between them must end all the same. */
#define ROULETTE_MOST 0.99f

/* AUTO: the factor of the root, and the guaranteed bounces. */
#define ROULETTE_ROOT 1.5f
enum { ROULETTE_AUTO_MIN = 1 };

/* A policy at one depth: survival = constant + slope T + root √T. */
typedef struct roulette { float constant, slope, root, most; } roulette;

static inline roulette roulette_make(const path_context *c, uint32_t depth) {
    bool beyond = depth >= c->max_depth; /* probes must end soon, whatever the policy */
    if (beyond || (c->roulette == KILN_ROULETTE_THROUGHPUT && depth >= c->roulette_min))
        return (roulette){.slope = 1.0f, .most = ROULETTE_MOST};
    if (c->roulette == KILN_ROULETTE_AUTO && depth >= ROULETTE_AUTO_MIN) return (roulette){.root = ROULETTE_ROOT, .most = ROULETTE_MOST};
    return (roulette){.constant = c->roulette == KILN_ROULETTE_FIXED ? c->roulette_p : 1.0f, .most = ROULETTE_MOST};
}

/* A medium that absorbs nothing is left sooner or later, and a hundredth off at each of a thousand events would leave
 * few paths with much to carry: there the most is 1. */
static inline roulette roulette_in_medium(const path_context *c, uint32_t depth) {
    roulette r = roulette_make(c, depth);
    r.most = 1.0f;
    return r;
}

KERNEL float roulette_survival(const roulette *r, vec3 throughput, float squeeze) {
    float largest = fm_max(v3_max(throughput) * squeeze, 0.0f);
    float survival = r->constant + fm_min(r->slope * largest + r->root * sqrtf(largest), r->most);
    return survival > 0.0f ? survival : 1.0f; /* a dead path needs no roulette */
}

/* What the throughput is multiplied with: 0 or 1/survival, by u in [0, 1). */
KERNEL float roulette_weight(const roulette *r, vec3 throughput, float squeeze, float u) {
    float survival = roulette_survival(r, throughput, squeeze);
    return u < survival ? 1.0f / survival : 0.0f;
}

#endif
