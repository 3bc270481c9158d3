/* image/icc.h: the colour profile that tells in a file what its numbers look like. */
#ifndef KILN_IMAGE_ICC_H
#define KILN_IMAGE_ICC_H

#include "image/image.h"

enum { IMAGE_ICC_MAX = 640 };

/* The profile of an RGB picture that is written with these options. Returns its length; 0: the options say nothing, or
 * name primaries or a curve that kiln has no numbers of. */
size_t image_icc(const kiln_image_write_options *, unsigned char bytes[IMAGE_ICC_MAX]);

#endif
