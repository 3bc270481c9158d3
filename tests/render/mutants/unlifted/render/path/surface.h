/* A mutant: smooth surfaces leave their light at the facets, whose own horizons cut it. */
#ifndef KILN_MUTANT_UNLIFTED_H
#define KILN_MUTANT_UNLIFTED_H

#define surface_smooth_sides surface_smooth_sides_original
#include_next "render/path/surface.h"
#undef surface_smooth_sides

KERNEL surface_sides surface_smooth_sides(const surface_point *p, const surface_triangle *t, vec3 wo) {
    (void)t, (void)wo;
    return surface_flat_sides(p);
}

#endif
