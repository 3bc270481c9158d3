/* render/world/media.h: the insides of solids: what lies behind the surfaces of materials with a volume. */
#ifndef KILN_RENDER_WORLD_MEDIA_H
#define KILN_RENDER_WORLD_MEDIA_H

#include "render/world/world.h"

/* Does light cross the surface: bent or straight on; in all directions? */
bool material_transmits(const kiln_material *);
bool material_is_translucent(const kiln_material *);

/* Does the material bound a solid? It has a volume with a thickness, and lets light in. */
bool material_is_solid(const kiln_material *);

/* Numbers the media by rank and fills the world's tables of them; used: which materials are in the picture's world, by
 * kiln_id. The materials' records exist. false: reported. */
bool world_build_media(world *, const kiln_scene *, const kiln_decoding *, const bool *used, kiln_report *);

/* Do the mesh's faces of a material leave holes? edges: how many of their sides have no counterpart. */
bool mesh_is_open(const kiln_mesh *, kiln_id material, size_t *edges);

#endif
