/* scene/mesh.h: a mesh as the scene keeps it. */
#ifndef KILN_SCENE_MESH_H
#define KILN_SCENE_MESH_H

#include "base/arena.h"
#include "base/report.h"
#include "kiln/mesh.h"

typedef struct kiln_mesh {
    kiln_arena arena; /* of everything below: a refined mesh replaces its cage */
    const char *name;
    uint32_t vertex_count, time_count /* ≥ 1 */, face_count, corner_count, triangle_count;
    const float *positions;        /* time_count × vertex_count × 3, finite */
    const uint32_t *face_offsets;  /* face f has the corners from face_offsets[f] to before face_offsets[f + 1]; NULL:
                                      triangles */
    const uint32_t *face_vertices; /* one per corner */
    const kiln_primvar *primvars;
    uint32_t primvar_count;
    kiln_id material;
    const kiln_id *face_materials; /* NULL: material everywhere */
    kiln_subdivision subdivision;
    float min[3], max[3]; /* over all times; min > max without vertices */
} kiln_mesh;

static inline uint32_t mesh_face_first(const kiln_mesh *m, uint32_t face) {
    return m->face_offsets ? m->face_offsets[face] : 3 * face;
}
static inline uint32_t mesh_face_size(const kiln_mesh *m, uint32_t face) {
    return m->face_offsets ? m->face_offsets[face + 1] - m->face_offsets[face] : 3;
}
static inline kiln_id mesh_face_material(const kiln_mesh *m, uint32_t face) {
    return m->face_materials ? m->face_materials[face] : m->material;
}

/* NULL: the mesh has none. */
const kiln_primvar *mesh_primvar(const kiln_mesh *, kiln_primvar_kind, uint32_t set);

/* Floats in a value. */
static inline uint32_t primvar_width(kiln_primvar_kind kind) {
    static const uint32_t width[] = {
        [KILN_PRIMVAR_NORMAL] = 3, [KILN_PRIMVAR_TANGENT] = 4, [KILN_PRIMVAR_UV] = 2, [KILN_PRIMVAR_COLOR] = 4};
    return width[kind];
}

/* Which of the values belongs to a corner of a face, of which face_vertices gives the vertex. */
static inline uint32_t primvar_index(const kiln_primvar *p, uint32_t face, uint32_t corner, uint32_t vertex) {
    uint32_t element = p->interpolation == KILN_VERTEX         ? vertex
                       : p->interpolation == KILN_FACE_VARYING ? corner
                       : p->interpolation == KILN_UNIFORM      ? face
                                                               : 0;
    return p->indices ? p->indices[element] : element;
}
static inline const float *primvar_at(const kiln_primvar *p, uint32_t face, uint32_t corner, uint32_t vertex) {
    return p->values + (size_t)primvar_width(p->kind) * primvar_index(p, face, corner, vertex);
}

#endif
