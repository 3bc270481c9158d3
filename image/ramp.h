/* image/ramp.h: false colours for maps of one number. */
#ifndef KILN_IMAGE_RAMP_H
#define KILN_IMAGE_RAMP_H

#include <stddef.h>

/* sRGB of a share 0 … 1 (clamped): from black through purple, red and orange to pale yellow. Lightness rises evenly, so
 * that the map is read in grey, too, and by people who confuse colours. */
void image_ramp(float share, float rgb[3]);
/* Where the ramp should end for these values: what one in a thousand is above, so that single ones do not darken the
 * rest; 0 when all are 0. Negative when memory is exhausted. */
float image_ramp_end(const float *values, size_t count);

#endif
