/* A mutant: the density of CLEARCOAT is 5 % too large. */
#ifndef KILN_MUTANT_DENSITY_OF_CLEARCOAT_H
#define KILN_MUTANT_DENSITY_OF_CLEARCOAT_H

#include "render/bsdf/lobes/sheen.h"
#include "render/bsdf/reflectance.h"

/* In layers.h nothing but clearcoat_pdf calls it. */
#define ggx_reflection_pdf(...) (1.05f * ggx_reflection_pdf(__VA_ARGS__))
#include_next "render/bsdf/layers.h"
#undef ggx_reflection_pdf

#endif
