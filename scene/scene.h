/* scene/scene.h: what a Scene holds, for the modules that fill, refine and read it. Handles are 1-based: object id
 * lies in slot id − 1. Everything was checked when it was added (kiln/scene.h): references are in range, numbers are
 * finite, texture transforms are explicit. Pointers into the scene are borrowed; before the commit the next object
 * of the same sort may move them. */
#ifndef KILN_SCENE_SCENE_H
#define KILN_SCENE_SCENE_H

#include "base/arena.h"
#include "base/file.h"
#include "base/mat.h"
#include "base/report.h"
#include "kiln/scene.h"
#include "scene/mesh.h"

typedef struct kiln_instance {
    const char *name, *asset; /* "": none */
    kiln_id mesh;
    uint32_t time_count; /* ≥ 1 */
    const mat4 *transforms;
    bool flat; /* at some time the transform is singular: no inverse */
} kiln_instance;

/* What an importer knows of the file beside its contents. */
typedef struct scene_extension {
    const char *name;
    bool required;
    const char *support; /* "read", "left out: highlights are round", … */
} scene_extension;

/* A place in the file's hierarchy; parents stand before their children, which follow them depth first. */
typedef struct scene_node {
    const char *name;
    uint32_t parent; /* in the same list; SCENE_NO_PARENT: a root */
    kiln_id mesh, camera, light; /* 0: none, or left out of the scene, as what is hidden is */
    mat4 local; /* in its parent's frame */
} scene_node;

#define SCENE_NO_PARENT UINT32_MAX

typedef struct scene_source {
    const char *format, *generator, *copyright; /* "glTF 2.0"; NULL: the scene came from a program, or unknown */
    const scene_extension *extensions;
    uint32_t extension_count;
    const scene_node *nodes;
    uint32_t node_count;
    const file_identity *files; /* that the asset consists of, whether or not all were read */
    size_t file_count;
} scene_source;

struct kiln_scene {
    kiln_arena arena; /* of everything but the arrays below and the meshes */
    kiln_image_desc *images;
    kiln_material *materials;
    kiln_mesh *meshes;
    kiln_instance *instances;
    kiln_light *lights;
    kiln_camera *cameras;
    uint32_t image_count, material_count, mesh_count, instance_count, light_count, camera_count;
    kiln_environment environment;
    bool has_environment;
    kiln_bounds bounds;
    bool committed;
    kiln_material default_material;
    scene_source source;
    const kiln_where *where; /* prefix of the places in messages, set by an importer; NULL: none */
};

/* Borrowed; the caller knows that the id is valid. Material 0 is the default material. */
static inline const kiln_image_desc *scene_image(const kiln_scene *s, kiln_id id) { return &s->images[id - 1]; }
static inline const kiln_material *scene_material(const kiln_scene *s, kiln_id id) {
    return id ? &s->materials[id - 1] : &s->default_material;
}
/* The name, borrowed, or in the arena what stands for one that is NULL or "": the prefix and the handle. NULL: no
 * memory. */
const char *scene_name(kiln_arena *, const char *name, const char *prefix, kiln_id handle);

/* What messages about an image of a scene begin with. */
static inline const char *scene_image_place(const kiln_image_desc *image) {
    return *image->place ? image->place : *image->name ? image->name : "image";
}
static inline const kiln_mesh *scene_mesh(const kiln_scene *s, kiln_id id) { return &s->meshes[id - 1]; }
static inline const kiln_instance *scene_instance(const kiln_scene *s, kiln_id id) { return &s->instances[id - 1]; }
static inline const kiln_light *scene_light(const kiln_scene *s, kiln_id id) { return &s->lights[id - 1]; }

/* Lets the light of a committed scene that nobody reads be changed; then close it again. Surfaces must stay as they
 * are: what the commit found out about them is kept. */
static inline void scene_set_open(kiln_scene *s, bool open) { s->committed = !open; }

/* The place of what is added next, for the messages of the adders; of a file alone, without anything in it, it is what
 * stands in front of the object's name. The chain must live until it is replaced; NULL: nothing. */
static inline void scene_locate(kiln_scene *s, const kiln_where *where) { s->where = where; }

/* The domains of a camera, for one that never enters a scene too; false is an error. */
bool camera_check(kiln_camera *, const kiln_where *, kiln_report *);

/* As kiln_scene_add_mesh, for arrays that need no copy: they lie in arena, which the mesh takes over (on failure it is
 * freed). */
bool scene_adopt_mesh(kiln_scene *, kiln_arena *arena, const kiln_mesh_desc *, kiln_id *id, kiln_report *);

/* Replaces a mesh of an uncommitted scene; its arrays are checked as kiln_scene_add_mesh does, but not copied: they
 * must lie in arena, which the mesh takes over (on failure it is freed and the old mesh stays). Threads may replace
 * different meshes at the same time. */
bool scene_replace_mesh(kiln_scene *, kiln_id, kiln_arena *arena, const kiln_mesh_desc *, kiln_report *);

#endif
