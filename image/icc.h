/* image/icc.h: the colour profile that tags JPEG and TIFF files as sRGB. */
#ifndef KILN_IMAGE_ICC_H
#define KILN_IMAGE_ICC_H

#include <stddef.h>
#include <stdint.h>

enum { IMAGE_ICC_SRGB_MAX = 640 };

/* Writes the profile and returns its length. */
size_t image_icc_srgb(unsigned char bytes[IMAGE_ICC_SRGB_MAX]);

#endif
