/* render/world/images.h: the pictures that a scene's materials use, decoded. */
#ifndef KILN_RENDER_WORLD_IMAGES_H
#define KILN_RENDER_WORLD_IMAGES_H

#include "base/report.h"
#include "kiln/material.h"
#include "kiln/render.h"
#include "scene/scene.h"

/* Larger radiances have sums and powers that are not finite. */
#define RADIANCE_LIMIT 1e30f

/* What a parameter takes from a picture: shares of light, angles and coverage lie in [0, 1], emission and tints of
 * reflections in [0, RADIANCE_LIMIT]. Floats may lie outside: they are clamped, and what is not finite is 0. */
typedef enum texel_domain { TEXELS_UNIT, TEXELS_POSITIVE, TEXEL_DOMAINS } texel_domain;

/* RGBA texels. U8 codes are shared by all uses, which differ in their curve; U16 codes by all that have none. The rest
 * is kept as linear floats, once for each curve and domain that is asked of them. */
typedef struct world_image {
    uint32_t width, height;
    kiln_pixel_format format;
    void *texels[1 + 2 * TEXEL_DOMAINS]; /* [0]: codes */
    void *levels[KILN_TRANSFER_COUNT + 2 * TEXEL_DOMAINS]; /* pyramids: of 8-bit codes by curve, of others by array */
    size_t level_bytes[KILN_TRANSFER_COUNT + 2 * TEXEL_DOMAINS];
    size_t bytes;                        /* of all */
    uint32_t wanted;                     /* bits of image_use */
    uint32_t filtered;                   /* those of them that want a pyramid */
    bool looked_at;                      /* the rest is known: */
    float low[4], high[4];               /* of each channel's codes, integers as shares of the largest; not below 0 */
} world_image;

static inline uint32_t image_use(kiln_transfer transfer, texel_domain domain) {
    return 1u << (domain * KILN_TRANSFER_COUNT + transfer);
}
/* The texels for a use that was wanted, after images_decode; *format is theirs. */
const void *image_texels(const world_image *, kiln_transfer, texel_domain, kiln_pixel_format *format);

/* The pyramid of a use that was to be filtered; NULL: it has none. */
const void *image_levels(const world_image *, kiln_transfer, texel_domain);

/* Decodes all images with wanted != 0, in parallel, and looks at them. images has one entry per image of the scene. Warns
 * of floats outside the domain. false: reported. */
bool images_decode(world_image *images, const kiln_scene *, float curves[KILN_TRANSFER_COUNT][256], uint32_t threads,
                   kiln_report *);
/* The same, but no pixel is kept: for the errors, all of them, and for what there is to see. */
bool images_look(world_image *images, const kiln_scene *, uint32_t threads, kiln_report *);
/* Frees what is wanted no more, now that wanted and filtered have fewer bits. */
void images_drop(world_image *images, uint32_t count);
void images_free(world_image *images, uint32_t count);

/* A picture as RGB floats (3 a pixel) in the working space; owned by the caller. */
bool image_load_linear(const kiln_image_desc *, kiln_transfer, const kiln_decoding *, uint32_t *width, uint32_t *height,
                       float **rgb, kiln_report *);

#endif
