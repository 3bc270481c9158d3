/* importers/mesh/tangents.h: tangent frames for normal maps.
 *
 * Morten S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008: the frames that glTF 2.0 (section 3.7.2.1,
 * meshes: "default MikkTSpace algorithms") and the tools that bake normal maps agree upon. */
#ifndef KILN_IMPORTERS_MESH_TANGENTS_H
#define KILN_IMPORTERS_MESH_TANGENTS_H

#include "base/report.h"

/* Three corners per triangle: positions and normals of 3 floats, uvs of 2, with v down from the top (glTF). Writes 4
 * floats per corner: a unit tangent along increasing u, at a right angle to the normal, and w = ±1, so that
 * w · cross(normal, tangent) points to decreasing v, which is up in the picture.
 *
 * Corners share a tangent when position, normal and uv are the same numbers, their triangles hang together by edges
 * around that point, and the uvs of those triangles are all mirrored or all not. Triangles without uv area take the
 * tangent of their group, triangles without extent that of any corner like theirs; where there is none, and for
 * non-finite input, the tangent is some unit vector. Never NaN. */
bool tangents_generate(const float *positions, const float *normals, const float *uvs, uint32_t triangle_count,
                       float *tangents, kiln_report *);

#endif
