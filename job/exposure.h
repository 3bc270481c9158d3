/* job/exposure.h: a quick look at a scene: an exposure for light in candela and lux, and whether emitters give any. */
#ifndef KILN_JOB_EXPOSURE_H
#define KILN_JOB_EXPOSURE_H

#include "kiln/render.h"

/* From a quick render of the same view: options are those of the render to come; its stop rules and its progress
 * are not used. width, height: of the picture. 0 when everything is black. */
bool exposure_choose(const kiln_renderer *, const kiln_render_options *, uint32_t width, uint32_t height, double *stops,
                     kiln_report *);

/* Whether the light that the renderer's scene has shows what the camera sees, at an exposure of 0. Arguments as above. */
bool exposure_is_lit(const kiln_renderer *, const kiln_render_options *, uint32_t width, uint32_t height, bool *lit,
                     kiln_report *);

/* From luminances, in any order (they are sorted): those of the surfaces that the picture shows. */
double exposure_of(float *luminance, size_t count);

#endif
