/* render/bsdf/lobes/ggx.h: the GGX distribution of microfacet normals, with an alpha along x and one along y.
 *
 * Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; masking-shadowing after Smith, height
 * correlated (Heitz 2014, "Understanding the Masking-Shadowing Function"); visible normals by spherical caps (Dupuy
 * and Benyoub 2023). Local frame: z is the normal, wo.z > 0. All expressions stay finite down to GGX_ALPHA_MIN and to
 * grazing directions: no tangent, no 1/cos. */
#ifndef KILN_RENDER_BSDF_LOBES_GGX_H
#define KILN_RENDER_BSDF_LOBES_GGX_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"

/* Below this the half vector of two float directions (relative error 2⁻²³ or so) no longer resolves the lobe to
 * 1/1000, and the lobe becomes a mirror. Roughness 0.01. */
#define GGX_ALPHA_MIN 1e-4f

/* |(alpha_x x, alpha_y y, z)|, the length that Smith's G1 = 2 cos/(cos + length) is made of. */
KERNEL float ggx_length(vec3 v, vec2 alpha) {
    float x = alpha.x * v.x, y = alpha.y * v.y;
    return sqrtf(v.z * v.z + x * x + y * y);
}

/* D(h) = 1/(π alpha_x alpha_y ((hx/alpha_x)² + (hy/alpha_y)² + hz²)²): the form that does not cancel near the normal. */
KERNEL float ggx_d(vec3 h, vec2 alpha) {
    float x = h.x / alpha.x, y = h.y / alpha.y, s = x * x + y * y + h.z * h.z;
    return 0.318309886f / (alpha.x * alpha.y * s * s);
}

/* A normal with density G1(wo) D(h) (wo·h)/wo.z. */
KERNEL vec3 ggx_sample_normal(vec3 wo, vec2 alpha, vec2 u) {
    vec3 s = v3_normalize(v3(wo.x * alpha.x, wo.y * alpha.y, wo.z));
    float z = (1.0f - u.x) * (1.0f + s.z) - s.z, r2 = 1.0f - z * z;
    float r = sqrtf(r2 > 0.0f ? r2 : 0.0f);
    fm_pair p = fm_sincos_2pi(u.y);
    float hz = z + s.z;
    vec3 h = v3((r * p.cos + s.x) * alpha.x, (r * p.sin + s.y) * alpha.y, hz > 1e-12f ? hz : 1e-12f);
    return v3_normalize(h);
}

/* Reflection. pdf = G1 D/(4 wo.z) = D/(2 (wo.z + length(wo))). */
KERNEL float ggx_reflection_pdf(vec3 wo, vec3 h, vec2 alpha) {
    return ggx_d(h, alpha) * 0.5f / (wo.z + ggx_length(wo, alpha));
}
/* f cos θi for F = 1: D G2/(4 wo.z), G2/(4 wo.z wi.z) = 1/(2 (wi.z length(wo) + wo.z length(wi))). wi.z > 0. */
KERNEL float ggx_reflection_value(vec3 wo, vec3 wi, vec3 h, vec2 alpha) {
    float visibility = 0.5f / (wi.z * ggx_length(wo, alpha) + wo.z * ggx_length(wi, alpha));
    return ggx_d(h, alpha) * visibility * wi.z;
}

/* The half vector of a refraction, on wo's side: −(wo + η wi) for η = n_far/n_near > 1, turned over for η < 1
 * (Walter eq. 16). Zero when there is none. */
KERNEL vec3 ggx_refraction_normal(vec3 wo, vec3 wi, float eta) {
    vec3 h = v3_madd(wo, eta, wi);
    float length2 = v3_dot(h, h), scale = length2 > 0.0f ? 1.0f / sqrtf(length2) : 0.0f;
    return v3_scale(h, h.z < 0.0f ? -scale : scale);
}
/* Refracts wo at h; c = wo·h > 0. The caller knows that there is no total reflection. */
KERNEL vec3 ggx_refract(vec3 wo, vec3 h, float c, float eta) {
    float k = 1.0f - (1.0f - c * c) / (eta * eta);
    float t = sqrtf(k > 0.0f ? k : 0.0f);
    return v3_sub(v3_scale(h, c / eta - t), v3_scale(wo, 1.0f / eta));
}
/* Density of refracted directions: G1 D (wo·h)/wo.z · η² |wi·h|/(wo·h + η wi·h)² (Walter eq. 17). wi.z < 0. */
KERNEL float ggx_refraction_pdf(vec3 wo, vec3 wi, vec3 h, vec2 alpha, float eta) {
    float co = v3_dot(wo, h), ci = v3_dot(wi, h), d = co + eta * ci;
    float d2 = d * d;
    d2 = d2 > 1e-20f ? d2 : 1e-20f; /* 0 only where co or ci is */
    float value = ggx_d(h, alpha) * 2.0f / (wo.z + ggx_length(wo, alpha)) * co * eta * eta * -ci / d2;
    return (co > 0.0f) & (ci < 0.0f) ? value : 0.0f;
}
/* value/pdf for 1 − F = 1: the far side shadows on its own (G1), and radiance is squeezed by 1/η² on its way back
 * to wo (Veach 1997, 5.2). */
KERNEL float ggx_refraction_multiplier(vec3 wi, vec2 alpha, float eta) {
    float c = -wi.z;
    return 2.0f * c / ((c + ggx_length(wi, alpha)) * eta * eta);
}

#endif
