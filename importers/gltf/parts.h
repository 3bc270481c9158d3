/* importers/gltf/parts.h: the primitives of one glTF mesh on their way to one mesh of the scene. */
#ifndef KILN_IMPORTERS_GLTF_PARTS_H
#define KILN_IMPORTERS_GLTF_PARTS_H

#include "importers/gltf/accessor.h"

/* A primitive that has a surface. */
typedef struct mesh_part {
    const gltf_primitive *primitive;
    size_t index; /* of the primitive, for places */
    size_t vertex_count, corner_count /* indices in the file */;
    size_t first_vertex; /* where its vertices begin in the mesh */
    bool shared;         /* an earlier part has the same attributes: its vertices are used */
    size_t first_face, face_count;
} mesh_part;

enum { PARTS_UV_SETS = 32, PARTS_PRIMVARS = 3 + PARTS_UV_SETS };

typedef struct mesh_parts {
    gltf_reader *r;
    const gltf_mesh *mesh;
    kiln_where where;
    kiln_arena arena; /* of everything that the scene will keep */
    mesh_part *parts;
    size_t count;
    size_t vertex_count, face_count;
    float *positions;
    uint32_t *corners; /* of triangles: vertices of the mesh */
    kiln_id *materials; /* of faces; NULL: all that of the first part */
    kiln_primvar primvars[PARTS_PRIMVARS];
    uint32_t primvar_count;
    kiln_subdivision subdivision;
} mesh_parts;

/* Memory from the mesh's arena, counted; NULL: an error was added. */
void *parts_array(mesh_parts *, size_t count, size_t size);

/* −1: the primitive does not have the attribute. */
int part_attribute(const mesh_part *, const char *name);

/* faces.c: corners of all parts, from indices and modes. */
bool parts_read_faces(mesh_parts *);
/* primvars.c: positions and attributes, one set of primvars for all parts. Where some
 * parts have an attribute and others do not: white colours, UVs of 0, normals of 0, which stand for the face's own. */
bool parts_read_primvars(mesh_parts *);
/* compact.c: drops vertices that no face uses (files share large vertex buffers among meshes). vertices, count: other
 * places that name vertices; those of dropped ones become UINT32_MAX. */
bool parts_compact(mesh_parts *, uint32_t *vertices, size_t count);
/* subdivision.c: what extras say about subdivision; *tags gets the vertices that creases and corners name. */
bool parts_read_subdivision(mesh_parts *, const gltf_value *extras, uint32_t **tags, size_t *tag_count,
                            const kiln_where *);

#endif
