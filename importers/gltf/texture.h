/* importers/gltf/texture.h: a use of a texture in a material. */
#ifndef KILN_IMPORTERS_GLTF_TEXTURE_H
#define KILN_IMPORTERS_GLTF_TEXTURE_H

#include "importers/gltf/reader.h"

/* The texture that info refers to, with its sampler, its UV set and KHR_texture_transform; its image is added to the
 * scene. Zero where there is none. transfer says how its numbers are meant here, channel which of them count: the
 * same image may be colour in one use and data in another. where: the textureInfo. */
bool gltf_read_texture(gltf_reader *, const gltf_texture_info *info, kiln_transfer, uint32_t channel, kiln_texture *,
                       const kiln_where *where);

/* The same for a textureInfo inside an extension: member key of the object. */
bool gltf_read_texture_member(gltf_reader *, const gltf_value *object, const char *key, kiln_transfer, uint32_t channel,
                              kiln_texture *, const kiln_where *where);

#endif
