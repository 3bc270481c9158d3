/* importers/mesh/complete.h: what a mesh needs for shading and did not bring.
 *
 * Each call gives *mesh another array of primvars, with one more (or one replaced), whose memory is the arena's; the
 * arrays that it had stay where they were. Sizes and indices are checked: an error names the face. Moving positions
 * are read at their first time. */
#ifndef KILN_IMPORTERS_MESH_COMPLETE_H
#define KILN_IMPORTERS_MESH_COMPLETE_H

#include "base/arena.h"
#include "base/report.h"
#include "kiln/scene.h"

/* What glTF asks for, of a mesh that is about to enter the scene (its materials are there already), or to replace
 * another: flat normals where there are none (tangents that came without normals are dropped), and tangents where
 * there are none and a material of the mesh has a normal map. */
bool complete_mesh(const kiln_scene *, kiln_mesh_desc *mesh, kiln_arena *, const kiln_where *, kiln_report *);

/* One normal per face (KILN_UNIFORM). Replaces normals that are there. */
bool complete_flat_normals(kiln_mesh_desc *mesh, kiln_arena *, const kiln_where *, kiln_report *);

/* One normal per corner (KILN_FACE_VARYING), smooth across edges that bend by at most crease_angle_rad. Replaces
 * normals that are there. */
bool complete_smooth_normals(kiln_mesh_desc *mesh, double crease_angle_rad, kiln_arena *, const kiln_where *,
                             kiln_report *);

/* One tangent per corner (KILN_FACE_VARYING) from a UV set, the one of the material's normal map; flat normals first,
 * where there are none. Replaces tangents that are there. A mesh without that UV set stays as it is. */
bool complete_tangents(kiln_mesh_desc *mesh, uint32_t uv_set, kiln_arena *, const kiln_where *, kiln_report *);

#endif
