/* A mutant: the density of GRAZING is 5 % too large. */
#ifndef KILN_MUTANT_DENSITY_OF_GRAZING_H
#define KILN_MUTANT_DENSITY_OF_GRAZING_H

#define grazing_pdf grazing_pdf_original
#include_next "render/bsdf/lobes/grazing.h"
#undef grazing_pdf

KERNEL float grazing_pdf(grazing_lobe g, float c) { return 1.05f * grazing_pdf_original(g, c); }

#endif
