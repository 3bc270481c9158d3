/* kiln/image.h: pictures as the scene takes them. */
#ifndef KILN_IMAGE_H
#define KILN_IMAGE_H

#include "kiln/api.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum kiln_pixel_format { KILN_PIXELS_U8, KILN_PIXELS_U16, KILN_PIXELS_F32 } kiln_pixel_format;

/* A picture: either a whole encoded file (PNG, JPEG, WebP, TIFF, OpenEXR, Radiance HDR), decoded only when a render
 * needs it, or pixels. Rows run from the top, channels interleaved, 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA; alpha is
 * straight (RGB under alpha 0 is kept). Sides have 1 to 65,536 pixels. The scene copies the data, unless release is
 * given: then the scene reads it in place and calls release(release_user) once when it no longer needs it, also when
 * adding the image fails. */
typedef struct kiln_image_desc {
    const char *name;  /* may be NULL */
    const char *place; /* where it stands in the user's file, for messages: "car.glb: images[1]"; NULL: the name says */
    const void *encoded;
    size_t encoded_size;
    const void *pixels;
    uint32_t width, height, channels;
    kiln_pixel_format format;
    void (*release)(void *release_user);
    void *release_user;
} kiln_image_desc;

#ifdef __cplusplus
}
#endif
#endif
