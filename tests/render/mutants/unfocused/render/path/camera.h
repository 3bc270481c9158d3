/* A mutant: the lens focuses a hundredth too far. */
#ifndef KILN_MUTANT_UNFOCUSED_H
#define KILN_MUTANT_UNFOCUSED_H

#define camera_ray_at camera_ray_at_original
#include_next "render/path/camera.h"
#undef camera_ray_at

KERNEL camera_ray camera_ray_at(const camera *c, float x, float y, vec2 lens_u) {
    camera further = *c;
    further.focus *= 1.01f;
    return camera_ray_at_original(&further, x, y, lens_u);
}

#endif
