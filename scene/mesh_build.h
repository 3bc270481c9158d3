/* scene/mesh_build.h: from a caller's description to a checked mesh; shared by mesh.c, primvar.c and tags.c. */
#ifndef KILN_SCENE_MESH_BUILD_H
#define KILN_SCENE_MESH_BUILD_H

#include "scene/scene.h"

typedef struct mesh_builder {
    const kiln_scene *scene;
    const kiln_mesh_desc *desc;
    kiln_mesh *mesh;
    bool adopt; /* the arrays already lie in the mesh's arena */
    const kiln_where *where;
    kiln_report *report;
} mesh_builder;

/* The caller's array for the mesh to keep: copied, or as it is. NULL: it is missing or memory ran out, and reported. */
void *mesh_keep(mesh_builder *, const void *array, size_t count, size_t size);

bool mesh_build_primvars(mesh_builder *);
bool mesh_build_tags(mesh_builder *);

#endif
