/* A mutant: the density of TRANSMISSION at a solid is 5 % too large. */
#ifndef KILN_MUTANT_DENSITY_OF_TRANSMISSION_H
#define KILN_MUTANT_DENSITY_OF_TRANSMISSION_H

#define ggx_refraction_pdf ggx_refraction_pdf_original
#include_next "render/bsdf/lobes/ggx.h"
#undef ggx_refraction_pdf

KERNEL float ggx_refraction_pdf(vec3 wo, vec3 wi, vec3 h, vec2 alpha, float eta) {
    return 1.05f * ggx_refraction_pdf_original(wo, wi, h, alpha, eta);
}

#endif
