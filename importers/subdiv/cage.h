/* importers/subdiv/cage.h: the control mesh of a subdivision surface, as OpenSubdiv wants it.
 *
 * A mesh that a triangles-only format has cut up is put together first: its vertices are welded by position, its
 * triangles paired into quads. Everything that OpenSubdiv would crash on is refused here. */
#ifndef KILN_IMPORTERS_SUBDIV_CAGE_H
#define KILN_IMPORTERS_SUBDIV_CAGE_H

#include "base/arena.h"
#include "base/report.h"
#include "kiln/mesh.h"

struct kiln_mesh;

/* Far keeps valences and face sizes in 16 bits; the work at a vertex grows with their squares. */
enum { CAGE_VALENCE_MAX = 4096 };

/* A primvar that is refined with the surface. */
typedef struct cage_channel {
    kiln_primvar_kind kind;
    uint32_t set, width;
    const float *values;
    uint32_t value_count;
    const uint32_t *indices; /* one per corner; NULL: value i belongs to vertex i and is refined as positions are */
} cage_channel;

typedef struct kiln_cage {
    uint32_t vertex_count, face_count, corner_count, time_count;
    const float *positions;         /* time_count × vertex_count × 3 */
    const uint32_t *face_sizes;
    const uint32_t *face_vertices;
    const uint32_t *vertex_sources; /* a vertex of the mesh for each vertex, */
    const uint32_t *corner_sources; /* a corner for each corner, */
    const uint32_t *face_sources;   /* a face for each face: the first of those that were joined */
    cage_channel *channels;
    uint32_t channel_count;
    kiln_subdivision rules; /* scheme, boundary rules, tags: on the cage's own vertices and faces */
    double quad_rate;       /* share of the triangles that were paired; 1 where nothing was triangulated */
} kiln_cage;

typedef struct cage_options {
    kiln_scheme scheme; /* NONE or AUTO: as the mesh asks, or as it looks */
    double crease_angle_rad; /* 0: none */
} cage_options;

/* Reads mesh, allocates in arena. False without an error when the topology cannot be refined: then *obstacle says
 * why ("face 7 has 70000 corners (at most 4096)"); with an error when memory ran out. */
bool cage_build(const struct kiln_mesh *, const cage_options *, kiln_arena *, kiln_cage *, char obstacle[160],
                const kiln_where *, kiln_report *);

/* Faces and triangles after `level` refinements; saturates at UINT64_MAX / 4. */
uint64_t cage_refined_faces(const kiln_cage *, uint32_t level);
uint64_t cage_refined_triangles(const kiln_cage *, uint32_t level);

#endif
