/* importers/subdiv/level.h: how often a cage must be refined for a view. */
#ifndef KILN_IMPORTERS_SUBDIV_LEVEL_H
#define KILN_IMPORTERS_SUBDIV_LEVEL_H

#include "base/mat.h"
#include "importers/subdiv/osd.h"
#include "scene/scene.h"

enum { LEVEL_MAX = 6, LEVEL_WITHOUT_VIEW = 2 };

/* A camera as far as sizes go: the eye, and how many pixels a metre is. */
typedef struct view_scale {
    bool present;
    bool orthographic;
    dvec3 eye;
    double pixels; /* per metre, at one metre's distance if in perspective */
} view_scale;

view_scale view_of_camera(const kiln_camera *, uint32_t height); /* camera may be NULL */

/* For every mesh the transform of the instance that the view shows largest; a zero matrix where there is none. NULL:
 * out of memory; free(). */
mat4 *level_largest_instances(const kiln_scene *, const view_scale *);

/* 99 % of the cage's edges have at most this many pixels. Negative: out of memory. */
double level_edge_pixels(const kiln_cage *, const mat4 *placement, const view_scale *);

/* The level at which, for 99 % of the edges, either they are a pixel long or the chord is a tenth of a pixel from the
 * limit surface; limit: the cage refined once. 1 … LEVEL_MAX; 0: out of memory. */
uint32_t level_for_view(const kiln_cage *, const osd_surface *limit, const mat4 *placement, const view_scale *);

#endif
