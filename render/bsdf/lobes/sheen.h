/* render/bsdf/lobes/sheen.h: the sheen of cloth: KHR_materials_sheen's "Charlie" lobe.
 *
 * D and Λ are those of KHR_materials_sheen, "Implementation Notes" (Estevez and Kulla 2017, "Production Friendly
 * Microfacet Sheen BRDF", eq. 2 to 4), alpha = sheen roughness², F = 1. As published they return more light than comes
 * where alpha is small, and at the horizon itself, where nothing holds the fitted Λ to a normalisation; three bounds
 * keep the directional albedo under 1. All of them are symmetric in wo and wi:
 * - Roughness is at least SHEEN_ROUGHNESS_MIN. The lobe spans some 3 alpha^½ above the horizon, 7° there; what is
 *   narrower says more about the normals' interpolation than about cloth.
 * - Under SHEEN_ROUGHNESS_FULL the lobe is scaled down in proportion to roughness, for its albedo grows as 1/roughness:
 *   it would be 1.02 at 0.25, and 2.1 at 0.1.
 * - Cosines count as SHEEN_COS_MIN at least, in Λ and in 1/(4 cos cos): at 10⁻⁶ the fit has an albedo of 1.5.
 * Local frame: z is the normal, wo.z > 0. */
#ifndef KILN_RENDER_BSDF_LOBES_SHEEN_H
#define KILN_RENDER_BSDF_LOBES_SHEEN_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"

#define SHEEN_ROUGHNESS_MIN 0.04f
#define SHEEN_ROUGHNESS_FULL 0.28f
#define SHEEN_COS_MIN 1e-4f
/* Elevations are sampled, and their albedos tabulated, over z/(z + SHEEN_SPREAD roughness). */
#define SHEEN_SPREAD 2.8f

/* NaN counts as 0. */
KERNEL float sheen_roughness(float roughness) { return fm_min(fm_max(roughness, SHEEN_ROUGHNESS_MIN), 1.0f); }

/* The exponent's curve l(x) of Λ; t = (1 − alpha)². x ≥ 0. */
KERNEL float sheen_curve(float x, float t) {
    float a = fm_lerp(21.5473f, 25.3245f, t), b = fm_lerp(3.82987f, 3.32435f, t), c = fm_lerp(0.19823f, 0.16801f, t);
    float d = fm_lerp(-1.97760f, -1.27393f, t), e = fm_lerp(-4.32054f, -4.85967f, t);
    return a / (1.0f + b * fm_exp2(c * fm_log2(x))) + d * x + e; /* x^c: 0 at 0 */
}
/* Λ, mirrored about the middle so that it falls to 0 towards the normal. */
KERNEL float sheen_lambda(float cosine, float alpha) {
    float t = (1.0f - alpha) * (1.0f - alpha);
    int low = cosine < 0.5f;
    float l = sheen_curve(low ? cosine : 1.0f - cosine, t);
    return fm_exp(low ? l : 2.0f * sheen_curve(0.5f, t) - l);
}

/* D(h) = (2 + 1/alpha) sin^(1/alpha)/(2π), of a half vector of any length, not 0. */
KERNEL float sheen_d(vec3 h, float alpha) {
    float side = h.x * h.x + h.y * h.y, sin2 = side / (side + h.z * h.z);
    return (2.0f + 1.0f / alpha) * 0.159154943f * fm_exp2(0.5f / alpha * fm_log2(sin2));
}

/* f cos θi for a white sheen of a sheen_roughness(): scale D V cos θi, V = 1/((1 + Λ(wo) + Λ(wi)) 4 cos cos). */
KERNEL float sheen_value(vec3 wo, vec3 wi, float roughness) {
    float alpha = roughness * roughness, scale = fm_min(roughness * (1.0f / SHEEN_ROUGHNESS_FULL), 1.0f);
    float co = fm_clamp(wo.z, SHEEN_COS_MIN, 1.0f), ci = fm_clamp(wi.z, SHEEN_COS_MIN, 1.0f);
    float visibility = 0.25f / ((1.0f + sheen_lambda(co, alpha) + sheen_lambda(ci, alpha)) * co * ci);
    float value = scale * sheen_d(v3_add(wo, wi), alpha) * visibility * wi.z;
    return wi.z > 0.0f ? value : 0.0f;
}

/* Around wo's plane the lobe is nearly even, and its elevations crowd at the horizon as alpha^½ does: azimuths are
 * uniform, z has the density s (1 + s)/(s + z)², s = SHEEN_SPREAD roughness. value/pdf stays under 3 for every wo
 * (sampling half vectors by D would put most of them where wi is below the horizon). */
KERNEL vec3 sheen_sample(vec2 u, float roughness) {
    float s = SHEEN_SPREAD * roughness, z = s * u.x / (1.0f + s - u.x), r2 = 1.0f - z * z; /* u.x < 1 */
    float r = sqrtf(r2 > 0.0f ? r2 : 0.0f);
    fm_pair p = fm_sincos_2pi(u.y);
    return v3(r * p.cos, r * p.sin, z);
}
KERNEL float sheen_pdf(vec3 wi, float roughness) {
    float s = SHEEN_SPREAD * roughness, d = s + wi.z;
    return wi.z > 0.0f ? s * (1.0f + s) * 0.159154943f / (d * d) : 0.0f;
}

#endif
