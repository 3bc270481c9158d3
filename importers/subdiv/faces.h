/* importers/subdiv/faces.h: the polygons that a mesh had before its format cut them up. */
#ifndef KILN_IMPORTERS_SUBDIV_FACES_H
#define KILN_IMPORTERS_SUBDIV_FACES_H

#include "importers/subdiv/edges.h"
#include "scene/mesh.h"

/* Which points of the mesh are one. */
typedef struct vertex_weld {
    uint32_t count;
    uint32_t *map;     /* vertex of the mesh → point; EDGE_NONE where no face uses it */
    uint32_t *sources; /* point → its first vertex */
} vertex_weld;

/* Vertices with the same position at every time (exact bits; −0 is 0) become one point, if by_position is given. */
bool weld_vertices(const kiln_mesh *, bool by_position, kiln_arena *, vertex_weld *);

/* Polygons made of the mesh's corners. */
typedef struct face_list {
    uint32_t face_count, corner_count;
    uint32_t *sizes;
    uint32_t *corners; /* a corner of the mesh for each corner */
    uint32_t *sources; /* a face of the mesh for each face: the first of those that were joined */
    uint32_t *points;  /* the point for each corner */
} face_list;

polygons faces_polygons(const face_list *, const vertex_weld *);

/* The mesh's own faces, without those in which a point repeats when drop_degenerate is given (a triangle without
 * area: its neighbours meet at its remaining edge). */
bool faces_take(const kiln_mesh *, const vertex_weld *, bool drop_degenerate, kiln_arena *, face_list *);

/* The mesh's polygons cut into triangles: Loop's scheme knows no others. */
bool faces_triangulate(const kiln_mesh *, const vertex_weld *, kiln_arena *, face_list *);

/* FB_ngon_encoding: a polygon is a fan of consecutive triangles around one vertex. A fan that does not chain up
 * (a, b, c), (a, c, d) begins another polygon, as writers exist that let neighbours share the first vertex. */
bool faces_join_fans(const kiln_mesh *, const vertex_weld *, kiln_arena *, face_list *);

/* Pairs consecutive triangles into quads where they look like the halves of one; *rate is the share of triangles
 * that found a partner. keep_edges: one byte per edge, not 0 where the edge must stay. */
bool faces_pair(const kiln_mesh *, const vertex_weld *, const face_list *triangles, const edge_table *,
                const uint8_t *keep_edges, kiln_arena *, face_list *, double *rate);

#endif
