/* importers/subdiv/edges.h: the edges of polygons. */
#ifndef KILN_IMPORTERS_SUBDIV_EDGES_H
#define KILN_IMPORTERS_SUBDIV_EDGES_H

#include "base/arena.h"

typedef struct polygons {
    uint32_t vertex_count, face_count, corner_count;
    const uint32_t *face_sizes; /* NULL: triangles */
    const uint32_t *face_vertices;
} polygons;

#define EDGE_NONE UINT32_MAX

typedef struct polygon_edge {
    uint32_t vertices[2]; /* the lower number first */
    uint32_t uses;        /* by how many faces: 1 at a boundary, above 2 it is no manifold */
    uint32_t corners[2];  /* the first two half-edges in the order of faces; [1]: EDGE_NONE at a boundary */
} polygon_edge;

typedef struct edge_table {
    uint32_t count;
    const polygon_edge *edges;            /* in the order of their vertices */
    const uint32_t *corner_edges; /* the edge from each corner to the next of its face */
    const uint32_t *first;        /* edges whose lower vertex is v: first[v] … first[v + 1] − 1 */
} edge_table;

/* NULL fields on failure: out of memory. Indices are in range. */
bool edges_build(const polygons *, kiln_arena *, edge_table *);

/* EDGE_NONE: no face has this edge. */
uint32_t edges_find(const edge_table *, uint32_t a, uint32_t b);

/* Two faces meet at the edge and agree on what is its front. */
static inline bool edge_is_regular(const polygon_edge *e, const uint32_t *face_vertices) {
    return e->uses == 2 && face_vertices[e->corners[0]] != face_vertices[e->corners[1]];
}

#endif
