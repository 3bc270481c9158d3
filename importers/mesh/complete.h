/* importers/mesh/complete.h: what a mesh needs for shading and did not bring.
 *
 * Each call gives *mesh another array of primvars, with one more (or one replaced), whose memory is the arena's; the
 * arrays that it had stay where they were. Face sizes and indices are checked: an error names the face. Moving
 * positions are read at their first time. A polygon counts as the fan of triangles around its first corner. */
#ifndef KILN_IMPORTERS_MESH_COMPLETE_H
#define KILN_IMPORTERS_MESH_COMPLETE_H

#include "base/arena.h"
#include "base/report.h"
#include "kiln/mesh.h"

/* The primvar of this kind and set; NULL: the mesh has none. */
const kiln_primvar *mesh_primvar(const kiln_mesh_desc *, kiln_primvar_kind, uint32_t set);

/* One normal per face (KILN_UNIFORM), as glTF asks for where normals are missing. Replaces normals that are there. */
bool mesh_add_flat_normals(kiln_mesh_desc *, kiln_arena *, const kiln_where *, kiln_report *);

/* One normal per corner (KILN_FACE_VARYING), smooth across edges that bend by at most crease_angle_rad. Replaces
 * normals that are there. */
bool mesh_add_smooth_normals(kiln_mesh_desc *, double crease_angle_rad, kiln_arena *, const kiln_where *,
                             kiln_report *);

/* One tangent per corner (KILN_FACE_VARYING) from a UV set, the one of the material's normal map; flat normals first,
 * where there are none. Replaces tangents that are there: they are worth nothing once normals or positions changed.
 * A mesh without that UV set stays as it is. */
bool mesh_add_tangents(kiln_mesh_desc *, uint32_t uv_set, kiln_arena *, const kiln_where *, kiln_report *);

#endif
