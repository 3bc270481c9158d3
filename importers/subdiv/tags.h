/* importers/subdiv/tags.h: what sharpens a cage, and what rides on it. */
#ifndef KILN_IMPORTERS_SUBDIV_TAGS_H
#define KILN_IMPORTERS_SUBDIV_TAGS_H

#include "importers/subdiv/cage.h"
#include "importers/subdiv/faces.h"

/* The mesh's creases as sharpness per edge, 0 where smooth; an edge that is tagged twice takes the greater one.
 * *lost counts creases along which no face has an edge. NULL: out of memory. */
float *tags_edge_sharpness(const kiln_mesh *, const vertex_weld *, const edge_table *, kiln_arena *, uint32_t *lost);

/* Makes edges infinitely sharp where faces bend by more than the angle. */
bool tags_crease_angle(const kiln_cage *, const edge_table *, double crease_angle_rad, float *edge_sharpness,
                       kiln_arena *);

/* Writes creases, corners and holes into cage->rules, which says so far what the mesh says. */
bool tags_apply(const kiln_mesh *, const vertex_weld *, const edge_table *, const float *edge_sharpness, kiln_arena *,
                kiln_cage *);

/* Collects the primvars that are refined with the surface: UVs and colours, and for the bilinear scheme, which rounds
 * nothing, normals. Values per vertex become values per corner where vertices were welded: corners of one point share
 * a value when their numbers, or where the mesh has indices the indices, are equal. */
bool channels_collect(const kiln_mesh *, bool welded, kiln_arena *, kiln_cage *);

#endif
