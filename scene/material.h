/* scene/material.h: walks over a material's parameters. */
#ifndef KILN_SCENE_MATERIAL_H
#define KILN_SCENE_MATERIAL_H

#include "kiln/material.h"

enum { KILN_MATERIAL_TEXTURES = 10 };

/* The textures that the material uses: those of absent layers are left out. Returns their number. */
uint32_t material_textures(const kiln_material *, const kiln_texture *textures[KILN_MATERIAL_TEXTURES]);

#endif
