/* A mutant: directions are uniform on the hemisphere instead of following the cosine. */
#ifndef KILN_MUTANT_HEMISPHERE_FOR_COSINE_H
#define KILN_MUTANT_HEMISPHERE_FOR_COSINE_H

#define warp_cosine warp_cosine_original
#include_next "render/sample/warp.h"
#undef warp_cosine

KERNEL vec3 warp_cosine(vec2 u) { return warp_cone(u, 1.0f); }

#endif
