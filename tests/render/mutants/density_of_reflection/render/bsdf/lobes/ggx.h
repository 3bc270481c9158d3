/* A mutant: the density of REFLECTION is 5 % too large. */
#ifndef KILN_MUTANT_DENSITY_OF_REFLECTION_H
#define KILN_MUTANT_DENSITY_OF_REFLECTION_H

#define ggx_reflection_pdf ggx_reflection_pdf_original
#include_next "render/bsdf/lobes/ggx.h"
#undef ggx_reflection_pdf

KERNEL float ggx_reflection_pdf(vec3 wo, vec3 h, vec2 alpha) { return 1.05f * ggx_reflection_pdf_original(wo, h, alpha); }

#endif
