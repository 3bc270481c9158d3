/* scene/bounds.h: the world's box. */
#ifndef KILN_SCENE_BOUNDS_H
#define KILN_SCENE_BOUNDS_H

#include "scene/scene.h"

static inline kiln_bounds bounds_empty(void) {
    return (kiln_bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

/* The box of all instances over the whole shutter, tight wherever one of mesh and instance is at rest. An instance
 * whose world positions are not finite is an error. */
bool bounds_of_scene(const kiln_scene *, kiln_bounds *, kiln_report *);

#endif
