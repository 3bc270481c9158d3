/* render/world/texture.h: decoded pictures, and how a point of one is looked up. */
#ifndef KILN_RENDER_WORLD_TEXTURE_H
#define KILN_RENDER_WORLD_TEXTURE_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"
#include "kiln/image.h"
#include "kiln/material.h"

/* Four channels a texel, whatever the file had: one fetch serves. Rows from the top. */
typedef struct world_texture {
    const void *texels;
    int32_t width, height;
    kiln_pixel_format format;
    kiln_wrap wrap_u, wrap_v;
    bool nearest;
    uint32_t uv_set;         /* 0: in the vertex; else world.uvs[uv_set] */
    uint32_t channel;        /* of a scalar parameter */
    float transform[6];
    const float *curve; /* 256 linear values for U8; wider formats are linear already */
    float matrix[9];
    bool has_matrix;    /* after the curve, into the working space */
} world_texture;

typedef struct texel { float r, g, b, a; } texel;

/* Linear colour (or data) at (u, v) of the texture's UV set, filtered; alpha is never curved. */
texel texture_sample(const world_texture *, float u, float v);
/* One channel of it. */
float texture_channel(const world_texture *, float u, float v);

#endif
