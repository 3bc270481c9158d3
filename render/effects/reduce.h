/* render/effects/reduce.h: a material without what nothing is seen of. */
#ifndef KILN_RENDER_EFFECTS_REDUCE_H
#define KILN_RENDER_EFFECTS_REDUCE_H

#include "kiln/effects.h"
#include "render/world/images.h"

/* What a material is judged by beside itself. */
typedef struct reduction {
    const world_image *images; /* of the scene, looked at; NULL: not yet, and a texture may be anything */
    uint64_t removed;          /* effects that the scene is to be without */
    float color_alpha;         /* the least alpha of vertex colours on it; 1 without */
} reduction;

/* Drops layers and textures that change nothing: what is multiplied by 0 everywhere, what opaque metal hides, maps that
 * are flat, coverage that is 1. What is left means the same, and is all that the renderer is told of. */
void material_reduce(kiln_material *, const reduction *);

/* The effects that a reduced material calls for, but for those of its textures (render/world/slots.h). */
uint64_t material_effects(const kiln_material *, const world_image *images);

/* Is a reduced material's surface a light? */
bool material_emits(const kiln_material *);

/* The least and the largest of value × texture. */
typedef struct parameter_range { float low, high; } parameter_range;
parameter_range param1_range(const kiln_param1 *, const world_image *images);

#endif
