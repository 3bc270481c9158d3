/* color/neutral.h: the Khronos PBR Neutral tone mapper.
 *
 * Khronos, "PBR Neutral Tone Mapper", 2024 (github.com/KhronosGroup/ToneMapping): linear Rec.709 in and out. Colours
 * whose brightest channel stays under 0.8 pass as they are, less the 4 % that a dielectric's specular reflection of
 * white surroundings adds to its base colour; above that, highlights approach white without turning their hue. */
#ifndef KILN_COLOR_NEUTRAL_H
#define KILN_COLOR_NEUTRAL_H

#include <stddef.h>

/* In place; finite input. Negative channels count as 0: the curve is defined from there on. */
void neutral_apply(float *rgb, size_t pixel_count);

#endif
