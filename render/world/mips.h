/* render/world/mips.h: pyramids of a picture: each level has half the texels of the one before, each way.
 *
 * A level is the mean of what it stands for, in linear light: a box filter, which for an odd number of texels weighs the
 * three that a new texel covers by their shares (Guthe and Heckbert 2005). Alpha is averaged apart from colour. */
#ifndef KILN_RENDER_WORLD_MIPS_H
#define KILN_RENDER_WORLD_MIPS_H

#include "render/world/texture.h"

/* Levels above the picture itself, down to one texel. */
int32_t mips_count(int32_t width, int32_t height);

/* A curve whose values a level can hold. */
bool mips_take(const float curve[256]);

/* All levels of the picture one behind the other, in the format of texture_grid's levels; *bytes is their size. Owned by
 * the caller: free. NULL: no memory. */
void *mips_make(const texture_grid *picture, size_t *bytes);

#endif
