/* render/bsdf/fresnel.h: how much a smooth interface reflects. */
#ifndef KILN_RENDER_BSDF_FRESNEL_H
#define KILN_RENDER_BSDF_FRESNEL_H

#include "base/kernel.h"
#include "base/vec.h"

/* (1 − c)^5, Schlick 1994 */
KERNEL float fresnel_schlick_weight(float c) {
    float m = 1.0f - c;
    m = m > 0.0f ? m : 0.0f;
    float m2 = m * m;
    return m2 * m2 * m;
}

/* KHR_materials_clearcoat: a dielectric of ior 1.5. */
#define CLEARCOAT_F0 0.04f

KERNEL float clearcoat_fresnel(float c) { return CLEARCOAT_F0 + (1.0f - CLEARCOAT_F0) * fresnel_schlick_weight(c); }

/* What a clear coat of this share lets through of what its surface emits, under a cosine ('Layering'). It is that to the
 * geometric normal: samples of lights, which know no other, must see what a hit sees. */
KERNEL float clearcoat_dims(float share, float c) { return 1.0f - share * clearcoat_fresnel(c); }

/* At normal incidence: ((η − 1)/(η + 1))², the same from either side. */
KERNEL float fresnel_normal(float eta) {
    float root = (eta - 1.0f) / (eta + 1.0f);
    return root * root;
}

/* Unpolarised reflectance of a dielectric: c = cos of the incident angle ≥ 0, eta = n_far / n_near.
 * F = ½ ((g − c)/(g + c))² (1 + ((c (g + c) − 1)/(c (g − c) + 1))²), g² = η² − 1 + c² (Cook and Torrance 1982);
 * 1 under total internal reflection. */
KERNEL float fresnel_dielectric(float c, float eta) {
    float g2 = eta * eta - 1.0f + c * c;
    float g = sqrtf(g2 > 0.0f ? g2 : 0.0f);
    float a = (g - c) / (g + c + 1e-30f); /* g = c = 0 only at eta = 1, grazing: then a is 0 */
    float b = (c * (g + c) - 1.0f) / (c * (g - c) + 1.0f); /* ≥ 1 − c² + c g: 0 only where g2 < 0 */
    float f = 0.5f * a * a * (1.0f + b * b);
    return g2 > 0.0f ? f : 1.0f;
}

#endif
