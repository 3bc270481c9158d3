/* render/world/lookup.h: what textures and vertices say at a point of a triangle, for those who have no hit there: the
 * filter of partial coverage and samples of lights. at: the barycentric weights of the second and the third corner. */
#ifndef KILN_RENDER_WORLD_LOOKUP_H
#define KILN_RENDER_WORLD_LOOKUP_H

#include "render/world/world.h"

vec2 lookup_uv(const world *, uint32_t triangle, uint32_t uv_set, vec2 at);

/* A triangle's corners in render space. */
void lookup_corners(const world *, uint32_t triangle, uint32_t instance, vec3 corners[3]);

/* Where a triangle's copy faces, in render space, of any length. */
vec3 lookup_facing(const world *, uint32_t triangle, uint32_t instance);

/* Opacity times texture times vertex colour. */
float lookup_alpha(const world *, uint32_t triangle, vec2 at);

/* What the material's emission is multiplied with: its texture, the part of the light that coverage lets stand (a ray meets
 * the surface with this probability), and what a clear coat lets through. cosine: of the direction that the light takes
 * to the normal of the front; below 0 it leaves the back. */
vec3 lookup_emission(const world *, uint32_t triangle, vec2 at, float cosine);

/* The handle of the scene's instance whose triangle this is. */
uint32_t lookup_object(const world *, uint32_t triangle, uint32_t copy);

/* Is that other than (1, 1, 1) anywhere? */
bool lookup_emission_varies(const world *, uint32_t triangle);

#endif
