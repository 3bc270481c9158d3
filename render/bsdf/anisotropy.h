/* render/bsdf/anisotropy.h: directional albedos of anisotropic GGX, as corrections of the isotropic tables (albedo.h).
 *
 * An anisotropic surface is stretched across its direction of greater roughness, y' = y αy/αx, until an isotropic one of
 * αx throws the same shadows; the stretched direction's cosine is what the isotropic tables are asked for, at the root
 * mean square of both alphas. Two factors lead from what they say to what is so: of the loss 1 − E, and of the cosine that
 * has Schlick's share. They are tabled over the stretched cosine, an azimuth, αx and αy/αx, linear between nodes, and
 * are 1 where both alphas are alike. */
#ifndef KILN_RENDER_BSDF_ANISOTROPY_H
#define KILN_RENDER_BSDF_ANISOTROPY_H

#include "base/vec.h"
#include "render/bsdf/albedo.h"

/* Columns of the cosine's coordinate (albedo.h), rows of azimuth, slices of αx, blocks of αy/αx. */
enum { ANISOTROPY_COSINES = 14, ANISOTROPY_TURNS = 5, ANISOTROPY_ALPHAS = 8, ANISOTROPY_RATIOS = 8 };
enum {
    ANISOTROPY_SLICE = ANISOTROPY_COSINES * ANISOTROPY_TURNS, ANISOTROPY_BLOCK = ANISOTROPY_SLICE * ANISOTROPY_ALPHAS,
    ANISOTROPY_SIZE = ANISOTROPY_BLOCK * ANISOTROPY_RATIOS
};
#define ANISOTROPY_LEAST_RATIO 0.005f /* under it hardly anything changes but in the stretched direction */
#define ANISOTROPY_LEAST_ALPHA 0.003f

/* Two factors to an entry, that of the loss in the low half, in units of 2⁻¹³: one gather for both. */
#define ANISOTROPY_UNIT 0x1p-13f
extern const int32_t anisotropy_table[ANISOTROPY_SIZE];

/* The factor of the mean loss. */
enum { ANISOTROPY_MEAN_ALPHAS = 32, ANISOTROPY_MEAN_RATIOS = 16 };
extern const float anisotropy_mean_table[ANISOTROPY_MEAN_ALPHAS * ANISOTROPY_MEAN_RATIOS];

/* The coordinate of αy/αx in [0, 1]: 0 for isotropic surfaces, so that a look-up gives them the node itself. */
KERNEL float anisotropy_ratio_at(float ratio) {
    float unit = (ratio - ANISOTROPY_LEAST_RATIO) / (1.0f - ANISOTROPY_LEAST_RATIO);
    return 1.0f - sqrtf(unit > 0.0f ? unit : 0.0f);
}

/* Where a surface lies in the table. */
typedef struct anisotropy_node { albedo_node alpha, ratio; float stretch; } anisotropy_node; /* stretch: αy/αx */

KERNEL anisotropy_node anisotropy_make(float larger, float smaller) {
    float ratio = (smaller + 1e-20f) / (larger + 1e-20f);
    return (anisotropy_node){albedo_node_of(sqrtf(larger), ANISOTROPY_ALPHAS),
                             albedo_node_of(anisotropy_ratio_at(ratio), ANISOTROPY_RATIOS), ratio};
}

KERNEL float anisotropy_mean(float larger, float ratio) {
    albedo_node column = albedo_node_of(sqrtf(larger), ANISOTROPY_MEAN_ALPHAS);
    albedo_node row = albedo_node_of(anisotropy_ratio_at(ratio), ANISOTROPY_MEAN_RATIOS);
    return albedo_bilinear(anisotropy_mean_table, ANISOTROPY_MEAN_ALPHAS, column, row);
}

/* A stretched direction: its cosine, its length before it was made a unit, and where it lies in azimuth. */
typedef struct anisotropy_direction { float mu, length, turn; } anisotropy_direction;

/* The azimuth counts as it is and as it is when stretched, for the loss follows the one, Schlick's share the other:
 * the mean of both cos². w.z ≥ 0, |w| = 1. */
KERNEL anisotropy_direction anisotropy_stretch(vec3 w, float stretch) {
    float x2 = w.x * w.x, y2 = w.y * w.y, s2 = y2 * stretch * stretch;
    float length = sqrtf(w.z * w.z + x2 + s2); /* w.z or x is not 0, but at the horizon with a stretch of 0 */
    float mu = w.z / (length + 1e-30f);
    return (anisotropy_direction){mu < 1.0f ? mu : 1.0f, length, 0.5f * (x2 / (x2 + y2 + 1e-30f) + x2 / (x2 + s2 + 1e-30f))};
}

typedef struct anisotropy_factors { float loss, cosine; } anisotropy_factors;

KERNEL anisotropy_factors anisotropy_entry(const int32_t *table, int32_t at) {
    int32_t both = table[at];
    return (anisotropy_factors){(float)(both & 0xffff), (float)(both >> 16)};
}
KERNEL anisotropy_factors anisotropy_between(anisotropy_factors a, anisotropy_factors b, float t) {
    return (anisotropy_factors){a.loss + t * (b.loss - a.loss), a.cosine + t * (b.cosine - a.cosine)};
}
KERNEL anisotropy_factors anisotropy_row(const int32_t *table, int32_t at, float column) {
    return anisotropy_between(anisotropy_entry(table, at), anisotropy_entry(table, at + 1), column);
}
KERNEL anisotropy_factors anisotropy_slice(const int32_t *table, int32_t at, float column, float row) {
    return anisotropy_between(anisotropy_row(table, at, column), anisotropy_row(table, at + ANISOTROPY_COSINES, column), row);
}

/* Of anisotropy_table; the generator has one of its own. larger: αx. */
KERNEL anisotropy_factors anisotropy_look_up(const int32_t *table, const anisotropy_node *a, anisotropy_direction d,
                                             float larger) {
    albedo_node column = albedo_node_of(albedo_cosine_at(d.mu, larger), ANISOTROPY_COSINES);
    albedo_node row = albedo_node_of(d.turn, ANISOTROPY_TURNS);
    int32_t at = column.index + row.index * ANISOTROPY_COSINES + a->alpha.index * ANISOTROPY_SLICE +
                 a->ratio.index * ANISOTROPY_BLOCK, next = at + ANISOTROPY_BLOCK;
    float c = column.fraction, r = row.fraction;
    anisotropy_factors low = anisotropy_between(anisotropy_slice(table, at, c, r),
                                                anisotropy_slice(table, at + ANISOTROPY_SLICE, c, r), a->alpha.fraction);
    anisotropy_factors high = anisotropy_between(anisotropy_slice(table, next, c, r),
                                                 anisotropy_slice(table, next + ANISOTROPY_SLICE, c, r), a->alpha.fraction);
    anisotropy_factors f = anisotropy_between(low, high, a->ratio.fraction);
    return (anisotropy_factors){f.loss * ANISOTROPY_UNIT, f.cosine * ANISOTROPY_UNIT};
}

#endif
