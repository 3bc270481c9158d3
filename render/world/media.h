/* render/world/media.h: the insides of solids: what lies behind the surfaces of materials with a volume. */
#ifndef KILN_RENDER_WORLD_MEDIA_H
#define KILN_RENDER_WORLD_MEDIA_H

#include "render/world/world.h"

/* Does light cross the surface: bent or straight on; in all directions? */
bool material_transmits(const kiln_material *);
bool material_is_translucent(const kiln_material *);

/* Does the material bound a solid? It has a volume with a thickness, and lets light in. */
bool material_is_solid(const kiln_material *);

/* An instance with a solid that may touch or overlap another; 0: there is none. false: out of memory, reported. */
bool media_find_touching(const reduced_scene *, kiln_id *instance, kiln_report *);

/* Numbers the media by rank and fills the world's tables of them. The materials' records exist. false: reported. */
bool world_build_media(world *, const reduced_scene *, const kiln_decoding *, kiln_report *);

/* Do the mesh's faces of a material leave holes? edges: how many of their sides have no counterpart. */
bool mesh_is_open(const kiln_mesh *, kiln_id material, size_t *edges);

#endif
