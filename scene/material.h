/* scene/material.h: walks over a material's parameters. */
#ifndef KILN_SCENE_MATERIAL_H
#define KILN_SCENE_MATERIAL_H

#include "kiln/material.h"

enum { KILN_MATERIAL_TEXTURES = 20 };

/* A parameter that may have a texture. */
typedef struct material_parameter {
    const char *name; /* of the field in kiln_material */
    int width;        /* 1: kiln_param1, 3: kiln_param3, 0: a texture alone */
    const float *values;
    const kiln_texture *texture;
} material_parameter;

/* Parameter i < KILN_MATERIAL_TEXTURES, in the order of kiln_material; false: it belongs to an absent layer. */
bool material_parameter_of(const kiln_material *, int i, material_parameter *);

/* The textures that the material uses: those of absent layers are left out. Returns their number. */
uint32_t material_textures(const kiln_material *, const kiln_texture *textures[KILN_MATERIAL_TEXTURES]);

/* The material needs tangents, for a normal map or for anisotropy; they follow this UV set. Where maps disagree, that
 * of the base's normal map decides. */
bool material_tangents(const kiln_material *, uint32_t *uv_set);

#endif
