/* render/bsdf/albedo.h: directional albedos of GGX interfaces and of sheen, for energy compensation, from tables.
 *
 * A table runs over a coordinate t of cos θ and over perceptual roughness, bilinear. Near grazing everything happens at
 * cos θ ~ alpha, hence sqrt(cos θ (1 + alpha)/(cos θ + alpha)); dips at critical angles want cos θ itself: t is a mixture
 * of both. What compensation makes of the tables is within 0.5 % (tests/render/test_bsdf_energy.c). Means are
 * cosine-weighted over the hemisphere, and of what look-ups give. */
#ifndef KILN_RENDER_BSDF_ALBEDO_H
#define KILN_RENDER_BSDF_ALBEDO_H

#include <math.h>
#include <stdint.h>

#include "render/bsdf/lobes/sheen.h"

enum { ALBEDO_COSINES = 32, ALBEDO_ROUGHNESS = 20, ALBEDO_IORS = 64 };
enum { ALBEDO_SLICE = ALBEDO_COSINES * ALBEDO_ROUGHNESS };
enum { ALBEDO_FINER = 8, ALBEDO_LOSSES = (ALBEDO_ROUGHNESS - 1) * ALBEDO_FINER + 1 }; /* rows of losses */
#define ALBEDO_COSINE_SHARE 0.3f /* of cos θ in t */
/* Slices of the interface table stand at x = ±ALBEDO_X_MAX k², x = (η − 1)/(η + 1): denser where η is near 1. */
#define ALBEDO_X_MAX 0.9f

/* With F = 1: what one scattering event returns; t by roughness. And 1 less its mean, over roughness, for under the first
 * row above 0 that hardly varies: near grazing a nearly smooth surface loses percents that its mean loss of 10⁻⁵ must
 * still scale. */
extern const float albedo_full_table[ALBEDO_SLICE];
extern const float albedo_full_loss_table[ALBEDO_LOSSES];
/* The share of it that goes with Schlick's (1 − cos)^5, as the one cosine c that has this share, over cos θ + alpha: that
 * is smooth where the share itself bends. And the mean of the product. */
extern const float albedo_schlick_table[ALBEDO_SLICE];
extern const float albedo_schlick_mean_table[ALBEDO_ROUGHNESS];
/* Reflection and refraction together at a dielectric interface: t by roughness by η of the far side over wo's. */
extern const float albedo_interface_table[ALBEDO_SLICE * ALBEDO_IORS];
extern const float albedo_interface_loss_table[ALBEDO_LOSSES * ALBEDO_IORS];

/* GGX alpha of a row. Roughness 0 is a mirror; its row is that of a roughness near enough to have a limit. */
KERNEL double albedo_row_alpha(int row) {
    double roughness = row ? (double)row / (ALBEDO_ROUGHNESS - 1) : 0.01;
    return roughness * roughness;
}

/* Where a value lies between two nodes of n. */
typedef struct albedo_node { int32_t index; float fraction; } albedo_node;

KERNEL albedo_node albedo_node_of(float unit, int32_t n) {
    float f = unit * (float)(n - 1);
    f = f > 0.0f ? f : 0.0f; /* NaN too */
    f = f < (float)(n - 1) ? f : (float)(n - 1);
    int32_t i = (int32_t)f;
    i = i < n - 2 ? i : n - 2;
    return (albedo_node){i, f - (float)i};
}

KERNEL float albedo_bilinear(const float *table, int32_t columns, albedo_node column, albedo_node row) {
    int32_t at = row.index * columns + column.index;
    float a = table[at] + column.fraction * (table[at + 1] - table[at]);
    float b = table[at + columns] + column.fraction * (table[at + columns + 1] - table[at + columns]);
    return a + row.fraction * (b - a);
}

KERNEL float albedo_linear(const float *table, albedo_node node) {
    return table[node.index] + node.fraction * (table[node.index + 1] - table[node.index]);
}

/* The coordinate of mu = cos θ ≥ 0, in [0, 1]. */
KERNEL float albedo_cosine_at(float mu, float alpha) {
    float grazing = sqrtf(mu * (1.0f + alpha) / (mu + alpha + 1e-30f)); /* alpha 0 at mu 0 */
    return (1.0f - ALBEDO_COSINE_SHARE) * grazing + ALBEDO_COSINE_SHARE * mu;
}
KERNEL albedo_node albedo_cosine_node(float mu, float alpha) {
    return albedo_node_of(albedo_cosine_at(mu, alpha), ALBEDO_COSINES);
}

/* One row of a material's roughness serves all look-ups of a shading point. */
KERNEL albedo_node albedo_roughness_node(float roughness) { return albedo_node_of(roughness, ALBEDO_ROUGHNESS); }

/* Mean losses bend more between rows than what they are the means of: their rows are finer. */
typedef struct albedo_loss { albedo_node row; float roughness; } albedo_loss;
KERNEL albedo_loss albedo_loss_of(albedo_node roughness) {
    float r = ((float)roughness.index + roughness.fraction) * (1.0f / (ALBEDO_ROUGHNESS - 1));
    return (albedo_loss){albedo_node_of(r, ALBEDO_LOSSES), r};
}

KERNEL float albedo_full(float mu, float alpha, albedo_node roughness) {
    return albedo_bilinear(albedo_full_table, ALBEDO_COSINES, albedo_cosine_node(mu, alpha), roughness);
}
KERNEL float albedo_full_mean_loss(albedo_node roughness) {
    albedo_loss l = albedo_loss_of(roughness);
    return l.roughness * albedo_linear(albedo_full_loss_table, l.row);
}

/* The cosine at which Schlick's weight is its share. */
KERNEL float albedo_schlick_cosine(float mu, float alpha, albedo_node roughness) {
    float relative = albedo_bilinear(albedo_schlick_table, ALBEDO_COSINES, albedo_cosine_node(mu, alpha), roughness);
    return relative * (mu + alpha);
}
KERNEL float albedo_schlick_mean(albedo_node roughness) {
    return albedo_linear(albedo_schlick_mean_table, roughness);
}

/* Where η of the far side over the near one lies among the slices of the interface table. */
KERNEL albedo_node albedo_ior_node(float eta) {
    float x = (eta - 1.0f) / (eta + 1.0f), k = sqrtf(fabsf(x) * (1.0f / ALBEDO_X_MAX));
    return albedo_node_of(0.5f + copysignf(0.5f * k, x), ALBEDO_IORS);
}

KERNEL float albedo_interface(albedo_node ior, float mu, float alpha, albedo_node roughness) {
    albedo_node column = albedo_cosine_node(mu, alpha);
    column.index += ior.index * ALBEDO_SLICE;
    float low = albedo_bilinear(albedo_interface_table, ALBEDO_COSINES, column, roughness);
    column.index += ALBEDO_SLICE;
    return low + ior.fraction * (albedo_bilinear(albedo_interface_table, ALBEDO_COSINES, column, roughness) - low);
}
KERNEL float albedo_interface_mean_loss(albedo_node ior, albedo_node roughness) {
    albedo_loss l = albedo_loss_of(roughness);
    return l.roughness * albedo_bilinear(albedo_interface_loss_table, ALBEDO_LOSSES, l.row, ior);
}

/* Of a white sheen lobe (lobes/sheen.h). Rows of roughness k/25 have one at each end and one at the kink,
 * SHEEN_ROUGHNESS_FULL; columns run over (z (1 + s)/(z + s))^¼, s = SHEEN_SPREAD roughness, the lobe's own elevations
 * and down to the horizon, where Λ's fit falls as a small power. */
enum { ALBEDO_SHEEN = 32, ALBEDO_SHEEN_ROUGHNESS = 25 };
extern const float albedo_sheen_table[ALBEDO_SHEEN * ALBEDO_SHEEN_ROUGHNESS];
extern const float albedo_sheen_mean_table[ALBEDO_SHEEN_ROUGHNESS];

KERNEL albedo_node albedo_sheen_node(float roughness) {
    float unit = (roughness - SHEEN_ROUGHNESS_MIN) * (1.0f / (1.0f - SHEEN_ROUGHNESS_MIN));
    return albedo_node_of(unit, ALBEDO_SHEEN_ROUGHNESS);
}

KERNEL float albedo_sheen(float mu, albedo_node roughness) {
    float s = SHEEN_SPREAD / ALBEDO_SHEEN_ROUGHNESS * ((float)(roughness.index + 1) + roughness.fraction);
    float t = sqrtf(sqrtf(mu * (1.0f + s) / (mu + s)));
    return albedo_bilinear(albedo_sheen_table, ALBEDO_SHEEN, albedo_node_of(t, ALBEDO_SHEEN), roughness);
}
KERNEL float albedo_sheen_mean(albedo_node roughness) {
    return albedo_linear(albedo_sheen_mean_table, roughness);
}

#endif
