/* tests/importers/subdiv/shapes.h: meshes for the tests of subdivision. */
#ifndef KILN_TESTS_SUBDIV_SHAPES_H
#define KILN_TESTS_SUBDIV_SHAPES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene/scene.h"

/* A description whose arrays lie in arena. */
typedef struct shape {
    kiln_arena arena;
    kiln_mesh_desc desc;
    kiln_primvar primvars[4];
} shape;

void shape_free(shape *);

/* The cube [-1, 1]³: 8 vertices, 6 quads, Catmull-Clark. */
void shape_cube(shape *);

/* A cube of n × n quads a side, blown up to a sphere: smooth normals, a UV square for each side of the cube. */
void shape_quad_sphere(shape *, uint32_t n, float radius);

/* A twenty-sided solid, split n times, on the unit sphere: smooth normals. Triangles. */
void shape_icosphere(shape *, uint32_t n);

/* A row of n quads in the plane z = 0, one unit each, with UVs that have a seam behind quad `seam` (n: none). */
void shape_strip(shape *, uint32_t n, uint32_t seam);

/* A closed cylinder of `sides` quads and two caps, its rims hard: normals per corner. */
void shape_cylinder(shape *, uint32_t sides);

/* What a glTF exporter makes of a mesh: vertices split wherever a primvar is, polygons cut to fans of triangles,
 * nothing said about subdivision. Every primvar becomes a vertex primvar. */
void shape_export(shape *result, const shape *source);

/* Adds the shape as mesh 1, 2, … */
kiln_id shape_add(kiln_scene *, const shape *, kiln_report *);

/* Edges of a mesh by the bits of their end points: how many there are, and how many are used by one face alone. */
typedef struct edge_census {
    uint32_t edges, open;
} edge_census;
edge_census shape_edges(const kiln_mesh *);

#endif
