/* A mutant: rays leave a surface from a fiftieth of the distance. */
#ifndef KILN_MUTANT_SHORT_REACH_H
#define KILN_MUTANT_SHORT_REACH_H

#define surface_at surface_at_original
#include_next "render/path/surface.h"
#undef surface_at

KERNEL surface_point surface_at(vec3 o, vec3 d, const surface_triangle *s) {
    surface_point p = surface_at_original(o, d, s);
    p.reach *= 0.02f;
    return p;
}

#endif
