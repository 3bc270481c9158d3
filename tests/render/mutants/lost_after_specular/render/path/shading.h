/* A mutant: a path forgets that its last bounce was perfectly specular, so emission found after it is left to light
 * samples, which cannot find it. */
#ifndef KILN_MUTANT_LOST_AFTER_SPECULAR
#define KILN_MUTANT_LOST_AFTER_SPECULAR

#define shading_scatter shading_scatter_original
#include_next "render/path/shading.h"
#undef shading_scatter

KERNEL shading_scattering shading_scatter(unsigned mask, const shading *s, vec3 throughput, float lobe, vec2 direction) {
    shading_scattering r = shading_scatter_original(mask, s, throughput, lobe, direction);
    r.pdf = fm_max(r.pdf, 1e-20f);
    return r;
}

#endif
