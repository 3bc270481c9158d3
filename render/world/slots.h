/* render/world/slots.h: which textures the parameters of a material are multiplied by. */
#ifndef KILN_RENDER_WORLD_SLOTS_H
#define KILN_RENDER_WORLD_SLOTS_H

#include "render/world/images.h"
#include "render/world/world.h"

/* A parameter and the slot its texture goes to. */
typedef struct slot_use {
    material_slot slot;
    const kiln_texture *texture;
    const float *factor; /* 3: a colour whose factor must be applied before the matrix into the working space */
} slot_use;

/* Those of a reduced material (render/effects/reduce.h); returns their number. */
int slots_list(const kiln_material *, slot_use uses[SLOT_COUNT]);

texel_domain slot_domain(material_slot);

/* Has the texture one value everywhere, which can be multiplied in once and for all? images as looked at, or NULL. */
bool slot_is_constant(const slot_use *, const world_image *images);

/* May the texture be averaged? */
bool slot_is_filtered(const kiln_material *, const slot_use *);

/* The effects that the material's textures call for. */
uint64_t slots_effects(const kiln_material *, const world_image *images, kiln_texture_filter);

#endif
