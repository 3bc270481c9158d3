/* render/world/texture.h: decoded pictures, and how a point of one is looked up. */
#ifndef KILN_RENDER_WORLD_TEXTURE_H
#define KILN_RENDER_WORLD_TEXTURE_H

#include "base/fmath.h"
#include "base/kernel.h"
#include "base/vec.h"
#include "kiln/image.h"
#include "kiln/material.h"

typedef struct texel { float r, g, b, a; } texel;

static inline size_t texel_bytes(kiln_pixel_format format) {
    return format == KILN_PIXELS_U8 ? 4 : format == KILN_PIXELS_U16 ? 8 : 16;
}

/* Four channels a texel, whatever the file had: one fetch serves. Rows from the top. */
typedef struct texture_grid {
    const void *texels;
    int32_t width, height;
    kiln_pixel_format format;
    const float *curve; /* 256 linear values for U8; wider formats are linear already */
} texture_grid;

typedef struct world_texture {
    const void *texels;
    int32_t width, height;
    kiln_pixel_format format;
    const void *levels;      /* of mips_make; NULL: the picture is not filtered */
    int32_t level_count;
    kiln_wrap wrap_u, wrap_v;
    bool nearest;
    uint32_t uv_set;         /* 0: in the vertex; else world.uvs[uv_set] */
    uint32_t channel;        /* of a scalar parameter */
    float transform[6];
    const float *curve; /* as in texture_grid */
    float matrix[9];
    bool has_matrix;    /* after the curve, into the working space */
} world_texture;

/* A symmetric 2 × 2 matrix. */
typedef struct metric2 { float xx, xy, yy; } metric2;

/* Its smaller eigenvalue, where both are ≥ 0. */
KERNEL float metric2_least(metric2 m) {
    float half = 0.5f * (m.xx + m.yy), det = fm_max(m.xx * m.yy - m.xy * m.xy, 0.0f);
    float most = half + sqrtf(fm_max(half * half - det, 0.0f));
    return det / fm_max(most, 1e-37f);
}

/* What a look-up may average over: the ellipse xᵀ F⁻¹ x ≤ 1 in the texture's UV set. 0: a point. */
typedef metric2 texture_footprint;

/* The level whose texels are at most half as long as the footprint's smaller axis is across: 0 is the picture. */
int32_t texture_level(const world_texture *, texture_footprint);

/* The grid above another: half as wide and high. Levels of 8-bit pictures are linear, in 16 bits: a half step there is
 * 2⁻¹⁷, a fortieth of the first step of sRGB. */
static inline texture_grid texture_grid_above(const texture_grid *g, const void *texels) {
    int32_t width = g->width > 1 ? g->width / 2 : 1, height = g->height > 1 ? g->height / 2 : 1;
    return (texture_grid){texels, width, height, g->format == KILN_PIXELS_F32 ? KILN_PIXELS_F32 : KILN_PIXELS_U16, NULL};
}
texel texture_load(const texture_grid *, int32_t x, int32_t y);

/* Linear colour (or data) at (u, v) of the texture's UV set, filtered; alpha is never curved. */
texel texture_sample(const world_texture *, float u, float v);
/* One channel of it. */
float texture_channel(const world_texture *, float u, float v);

/* The same in two steps, so that the caches can be told of the first while others are looked up. What a look-up reads:
 * four texels of a level, and their weights. */
typedef struct texture_tap {
    texture_grid grid;
    int32_t i0, i1, j0, j1; /* columns, rows */
    float fx, fy;           /* of i1, of j1 */
} texture_tap;
/* Written where it is kept: a tap that is copied is read before its parts have reached the cache, which costs more than
 * the look-up. */
void texture_find(const world_texture *, float u, float v, int32_t level, texture_tap *);
void texture_prefetch(const texture_tap *);
texel texture_read(const world_texture *, const texture_tap *);
float texture_read_channel(const world_texture *, const texture_tap *);

/* Both at once. */
texel texture_sample_level(const world_texture *, float u, float v, int32_t level);
float texture_channel_level(const world_texture *, float u, float v, int32_t level);

#endif
