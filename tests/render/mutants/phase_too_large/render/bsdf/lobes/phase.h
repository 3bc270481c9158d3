/* A mutant: the phase function, its own density, is 5 % too large. */
#ifndef KILN_MUTANT_PHASE_TOO_LARGE_H
#define KILN_MUTANT_PHASE_TOO_LARGE_H

#define phase_value phase_value_original
#include_next "render/bsdf/lobes/phase.h"
#undef phase_value

KERNEL float phase_value(vec3 wo, vec3 wi, float g) { return 1.05f * phase_value_original(wo, wi, g); }

#endif
