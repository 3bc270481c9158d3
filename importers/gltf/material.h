/* importers/gltf/material.h: the parts of reading a material. where: the material. */
#ifndef KILN_IMPORTERS_GLTF_MATERIAL_H
#define KILN_IMPORTERS_GLTF_MATERIAL_H

#include "importers/gltf/reader.h"

/* material.c: opacity is the alpha of the base colour and its texture, where the mode does not ignore it. */
void gltf_use_alpha(kiln_material *, double factor);

/* material_layers.c: KHR_materials_pbrSpecularGlossiness stands in for pbrMetallicRoughness. */
bool gltf_is_specular_glossy(const gltf_material *);
/* All extensions, on what pbrMetallicRoughness and the maps have said. Those that the specifications exclude beside
 * others, or that lack what they build on, are left out with a warning. */
bool gltf_read_layers(gltf_reader *, const gltf_material *, kiln_material *, const kiln_where *);

#endif
