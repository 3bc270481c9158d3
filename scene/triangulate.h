/* scene/triangulate.h: the triangles of polygons. */
#ifndef KILN_SCENE_TRIANGULATE_H
#define KILN_SCENE_TRIANGULATE_H

#include "scene/mesh.h"

/* The mesh's triangles in the order of its faces, n − 2 for a face of n corners, with the face's winding: corners gets
 * 3 × triangle_count indices into face_vertices (corner numbers, by which face-varying values are found), faces the
 * face of each triangle; faces may be NULL. A mesh without face_offsets has triangle t at corners 3t … 3t + 2 already.
 * The shape of a moving mesh at its first time decides. False only when memory is exhausted. */
bool mesh_triangulate(const kiln_mesh *, uint32_t *corners, uint32_t *faces);

#endif
