/* importers/mesh/normals.h: normals for meshes that bring none. All results are unit vectors, for any input; where
 * a face has no area, an arbitrary one. */
#ifndef KILN_IMPORTERS_MESH_NORMALS_H
#define KILN_IMPORTERS_MESH_NORMALS_H

#include "base/report.h"

/* Of one polygon, planar or not: the mean over its area. vertices index positions of 3 floats each. */
void normals_face(const float *positions, const uint32_t *vertices, uint32_t vertex_count, float normal[3]);

/* Of every corner of a triangle soup (three positions per triangle): the mean over the faces that meet at the point
 * and hang together by edges which bend by no more than crease_angle_rad, weighted by area and by angle at the
 * point. π or more: smooth everywhere. */
bool normals_smooth(const float *positions, uint32_t triangle_count, double crease_angle_rad, float *normals,
                    kiln_report *);

#endif
