/* importers/subdiv/decide.h: is a mesh that says nothing about subdivision a smooth surface?
 *
 * A finished model's vertices lie on the surface that it means, and its normals are that surface's. So its cage is
 * fitted to it first (osd_fit), and the limit surface is held against what vertices and normals promise: in the middle
 * of an edge, the cubic that they span (Vlachos et al., "Curved PN Triangles", 2001, equation of b210). */
#ifndef KILN_IMPORTERS_SUBDIV_DECIDE_H
#define KILN_IMPORTERS_SUBDIV_DECIDE_H

#include "importers/subdiv/osd.h"
#include "scene/mesh.h"

/* Lengths are shares of the diagonal of the mesh's bounds. */
typedef struct smoothness {
    double split;         /* share of the points whose authored normals are missing, or differ by more than a degree */
    double normal_rad;    /* between authored and limit normals; 99 % of the corners stay under it */
    double deviation;     /* of the limit from the promised surface; 99 % of the places stay under it */
    double deviation_max; /* at the worst place */
    double slide;         /* along the surface, at most: textures are stretched by it, the shape is not */
    double bulge;         /* of the limit from the polygons, at most: what refining changes at all */
} smoothness;

/* once: the fitted cage, refined once. The mesh has normals. False: out of memory. */
bool smoothness_measure(const kiln_mesh *, const kiln_cage *, const osd_surface *once, smoothness *);

/* Whether refining rounds the polygons off and changes nothing else; reason says why, either way. */
bool smoothness_decide(const smoothness *, char reason[160]);

#endif
