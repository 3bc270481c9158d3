/* A mutant: the density of SHEEN is 5 % too large. */
#ifndef KILN_MUTANT_DENSITY_OF_SHEEN_H
#define KILN_MUTANT_DENSITY_OF_SHEEN_H

#define sheen_pdf sheen_pdf_original
#include_next "render/bsdf/lobes/sheen.h"
#undef sheen_pdf

KERNEL float sheen_pdf(vec3 wi, float roughness) { return 1.05f * sheen_pdf_original(wi, roughness); }

#endif
