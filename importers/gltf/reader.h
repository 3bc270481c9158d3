/* importers/gltf/reader.h: the state of one import, and the steps that share it. Every step returns false exactly when
 * it added an error. */
#ifndef KILN_IMPORTERS_GLTF_READER_H
#define KILN_IMPORTERS_GLTF_READER_H

#include "base/arena.h"
#include "base/file.h"
#include "base/mat.h"
#include "importers/gltf/buffers.h"
#include "importers/gltf/container.h"
#include "importers/gltf/document.h"
#include "importers/gltf/envelope.h"
#include "scene/scene.h"

/* A mesh of the file at a place in the world. */
typedef struct gltf_placement {
    size_t node, root; /* root: the node at the top of the hierarchy, above it or itself */
    mat4 transform;
} gltf_placement;

typedef struct gltf_reader {
    const char *path;   /* of the asset, "-" for standard input; NULL: it came from memory */
    const char *folder; /* of the asset, where relative URIs start; NULL: none */
    bool allow_outside; /* URIs may leave the folder */
    kiln_where file;
    kiln_report *report;
    uint64_t budget; /* bytes that may still be allocated */
    kiln_arena arena; /* freed with the import */
    gltf_blob *bytes; /* the file itself */
    gltf_container container;
    gltf_envelope envelope;
    gltf_document document;
    gltf_buffer *buffers; /* as many as envelope.buffers */
    kiln_scene *scene;
    kiln_id *images;      /* of the scene, by image of the file; 0: not yet added */
    kiln_id *materials;   /* likewise */
    kiln_id *meshes;
    gltf_placement *placements; /* found by place_nodes, in the order of the hierarchy */
    size_t placement_count;
    scene_node *nodes; /* of the scene's source; until gltf_link_nodes, mesh is that of the file */
} gltf_reader;

/* Takes bytes from the budget, or reports that there are not enough. */
bool reader_reserve(gltf_reader *, uint64_t bytes, const kiln_where *);
/* Memory from the reader's arena, counted; NULL: an error was added. */
void *reader_array(gltf_reader *, size_t count, size_t size, const kiln_where *);

/* check.c, check_nodes.c: all indices lead somewhere, all ranges lie in their buffers, the nodes form trees. */
bool gltf_check_document(gltf_reader *);
bool gltf_check_nodes(gltf_reader *);
/* An index of the file, −1 standing for none: "texture 12 does not exist (the file has 3)". */
bool gltf_check_index(const gltf_reader *, int index, size_t count, bool none_allowed, const char *noun,
                      const kiln_where *);
/* The same for the property key of an object; −1 is fine. */
bool gltf_check_key(const gltf_reader *, int index, size_t count, const char *noun, const kiln_where *object,
                    const char *key);

/* material.c: adds all materials, and the images that they use. */
bool gltf_add_materials(gltf_reader *);
/* image.c: the scene's handle of an image of the file, added on first use. */
bool gltf_add_image(gltf_reader *, int image, kiln_id *id);

/* node.c: walks the scene; finds the placements of meshes, adds cameras and lights. */
bool gltf_place_nodes(gltf_reader *);
/* When the meshes are there: the nodes that the scene keeps for those who ask name them. */
void gltf_link_nodes(gltf_reader *);
/* mesh.c: adds the meshes that have placements. */
bool gltf_add_meshes(gltf_reader *);
/* instancing.c: adds the instances, those of EXT_mesh_gpu_instancing too. */
bool gltf_add_instances(gltf_reader *);

#endif
