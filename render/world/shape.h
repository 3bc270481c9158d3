/* render/world/shape.h: a mesh as triangles of unified vertices: one index finds position and all attributes. */
#ifndef KILN_RENDER_WORLD_SHAPE_H
#define KILN_RENDER_WORLD_SHAPE_H

#include "render/world/world.h"

typedef struct shape {
    const kiln_mesh *mesh; /* NULL: no instance shows it */
    uint32_t uses;         /* instances that Embree could place */
    bool baked;            /* those are written out in render space too; else the mesh is once, and Embree places it */
    uint32_t vertex_count, triangle_count, coverage_count; /* triangles whose material has partial coverage */
    uint32_t *corners;     /* 3 a triangle, corner numbers; NULL: corner 3t + k */
    uint32_t *faces;       /* one a triangle; NULL: t */
    uint32_t *vertices;    /* 3 a triangle; NULL: the mesh's own vertices are unified already */
    uint32_t *source;      /* 2 a unified vertex: face and corner that it came from; NULL as above */
    uint32_t prototype;    /* not baked: its number */
} shape;

/* Fills everything but uses and baked. Vertices that differ in a primvar that w's materials read are kept apart.
 * false: out of memory. */
bool shape_make(shape *, const world *w);
void shape_free(shape *);

static inline uint32_t shape_face(const shape *s, uint32_t triangle) { return s->faces ? s->faces[triangle] : triangle; }
static inline uint32_t shape_corner(const shape *s, uint32_t triangle, uint32_t k) {
    return s->corners ? s->corners[3 * (size_t)triangle + k] : 3 * triangle + k;
}
static inline uint32_t shape_vertex(const shape *s, uint32_t triangle, uint32_t k) {
    return s->vertices ? s->vertices[3 * (size_t)triangle + k]
                       : s->mesh->face_vertices[shape_corner(s, triangle, k)];
}
/* Face, corner and mesh vertex that a unified vertex stands for. Without a source only the mesh vertex matters. */
static inline void shape_source(const shape *s, uint32_t vertex, uint32_t *face, uint32_t *corner, uint32_t *mesh_vertex) {
    *face = s->source ? s->source[2 * (size_t)vertex] : 0;
    *corner = s->source ? s->source[2 * (size_t)vertex + 1] : 0;
    *mesh_vertex = s->source ? s->mesh->face_vertices[*corner] : vertex;
}
static inline bool shape_has_coverage(const world *w, const shape *s, uint32_t triangle) {
    kiln_id material = mesh_face_material(s->mesh, shape_face(s, triangle));
    return w->materials[material].flags & (MATERIAL_MASK | MATERIAL_BLEND);
}

/* The primvars that unified vertices carry; NULL where the mesh has none or nothing reads it. */
typedef struct shape_primvars {
    const kiln_primvar *normal, *tangent, *color, *uv[WORLD_UV_SETS];
} shape_primvars;
shape_primvars shape_read_primvars(const shape *, const world *w);

#endif
