/* render/bsdf/shares.h: which of a BSDF's lobes light comes by, for films that hold parts of the picture.
 *
 * A direction that can be evaluated is shared out by the values of the lobes there, for each channel: what a lobe sends
 * on is what is missing when it is muted. So the split of a sampled direction has no noise of its own, and does not
 * depend on which lobe it was drawn from. What is not muted by name is reflection on wo's side, transmission behind. */
#ifndef KILN_RENDER_BSDF_SHARES_H
#define KILN_RENDER_BSDF_SHARES_H

#include "kiln/film.h"
#include "render/bsdf/bsdf.h"

/* Shares of what a BSDF sends on, by channel; they sum to 1 but for rounding. */
typedef struct bsdf_parts { vec3 of[KILN_LOBE_COUNT]; } bsdf_parts;

/* The lobes that share a side with others. */
static inline bsdf bsdf_without(const bsdf *b, kiln_lobe lobe) {
    bsdf rest = *b;
    switch (lobe) {
    case KILN_LOBE_DIFFUSE: rest.diffuse = v3_splat(0.0f); break;
    case KILN_LOBE_CLEARCOAT: rest.clearcoat.gloss = 0.0f; break;
    case KILN_LOBE_SHEEN: rest.sheen.color = v3_splat(0.0f); break;
    case KILN_LOBE_TRANSLUCENCY: rest.passes = v3_splat(0.0f); break;
    case KILN_LOBE_EMISSION:
    case KILN_LOBE_SPECULAR:
    case KILN_LOBE_TRANSMISSION:
    case KILN_LOBE_COUNT: break;
    }
    return rest;
}

static inline float bsdf_share(float all, float without) {
    return all > 0.0f ? fm_clamp((all - without) / all, 0.0f, 1.0f) : 0.0f;
}

/* Of a direction that is no delta's. */
static inline bsdf_parts bsdf_shares(unsigned mask, const bsdf *b, vec3 wi) {
    bsdf_parts shares = {0};
    vec3 all = bsdf_evaluate(mask, b, wi).value, left = v3_splat(1.0f);
    for (int l = 0; l < KILN_LOBE_COUNT; l++) {
        bsdf rest = bsdf_without(b, (kiln_lobe)l);
        vec3 without = bsdf_evaluate(mask, &rest, wi).value;
        shares.of[l] = v3(bsdf_share(all.x, without.x), bsdf_share(all.y, without.y), bsdf_share(all.z, without.z));
        left = v3_sub(left, shares.of[l]);
    }
    shares.of[wi.z > 0.0f ? KILN_LOBE_SPECULAR : KILN_LOBE_TRANSMISSION] = v3_scale(v3_add(left, v3_abs(left)), 0.5f);
    return shares;
}

/* Of the direction that bsdf_sample chooses with these numbers. */
static inline bsdf_parts bsdf_shares_of_sample(unsigned mask, const bsdf *b, float lobe, vec2 direction) {
    bsdf_sampled next = bsdf_sample(mask, b, lobe, direction);
    if (next.pdf > 0.0f) return bsdf_shares(mask, b, next.wi);
    bsdf_parts shares = {0};
    int clearcoat = mask & BSDF_CLEARCOAT && bsdf_choose(mask, b, lobe, 1.0f).clearcoat;
    kiln_lobe delta = next.crosses ? KILN_LOBE_TRANSMISSION : clearcoat ? KILN_LOBE_CLEARCOAT : KILN_LOBE_SPECULAR;
    shares.of[delta] = v3_splat(1.0f);
    return shares;
}

#endif
