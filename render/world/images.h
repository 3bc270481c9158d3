/* render/world/images.h: the pictures that a scene's materials use, decoded. */
#ifndef KILN_RENDER_WORLD_IMAGES_H
#define KILN_RENDER_WORLD_IMAGES_H

#include "base/report.h"
#include "kiln/material.h"
#include "kiln/render.h"
#include "scene/scene.h"

/* RGBA texels. U8 codes are shared by all transfers, which differ in their curve; wider formats are kept linear, once
 * for each curve that is asked of them. */
typedef struct world_image {
    uint32_t width, height;
    kiln_pixel_format format;
    void *codes;  /* U8; or data and linear use of the others */
    float *srgb;  /* sRGB use of U16 and F32, decoded */
    uint32_t wanted; /* bits of kiln_transfer */
} world_image;

/* Decodes all images with wanted != 0, in parallel. images has one entry per image of the scene. */
bool images_decode(world_image *images, const kiln_scene *, uint32_t threads, kiln_report *);
/* The same for the errors alone: all of them, and no pixel is kept. */
bool images_check(const world_image *images, const kiln_scene *, uint32_t threads, kiln_report *);
void images_free(world_image *images, uint32_t count);

/* A picture as RGB floats (3 a pixel) in the working space; owned by the caller. */
bool image_load_linear(const kiln_image_desc *, kiln_transfer, const kiln_decoding *, uint32_t *width, uint32_t *height,
                       float **rgb, kiln_report *);

#endif
