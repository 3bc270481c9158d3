/* A mutant: the density of DIFFUSE is 5 % too large. */
#ifndef KILN_MUTANT_DENSITY_OF_DIFFUSE_H
#define KILN_MUTANT_DENSITY_OF_DIFFUSE_H

#define diffuse_pdf diffuse_pdf_original
#include_next "render/bsdf/lobes/diffuse.h"
#undef diffuse_pdf

KERNEL float diffuse_pdf(vec3 wi, float side) { return (side > 0.0f ? 1.05f : 1.0f) * diffuse_pdf_original(wi, side); }

#endif
