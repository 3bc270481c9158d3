/* Where things stand: the file's hierarchy, and what it places in the world. */
#include <stdlib.h>

#include "job/inspect.h"
#include "scene/scene.h"

static json_t *index_of(kiln_id id) { return id ? json_integer(id - 1) : json_null(); }

json_t *inspect_nodes(const kiln_scene *scene) {
    const scene_source *source = &scene->source;
    json_t *array = json_array();
    for (uint32_t i = 0; i < source->node_count; i++) {
        const scene_node *n = &source->nodes[i];
        json_t *o = json_object();
        put_text(o, "name", n->name);
        put(o, "parent", n->parent == SCENE_NO_PARENT ? json_null() : json_integer(n->parent));
        put(o, "mesh", index_of(n->mesh));
        put(o, "camera", index_of(n->camera));
        put(o, "light", index_of(n->light));
        put(o, "matrix", json_numbers_of(n->local.m, 16));
        (void)json_array_append_new(array, o);
    }
    return array;
}

/* The names of the materials of a mesh, each once. */
static json_t *materials_of(const kiln_scene *scene, const kiln_mesh *mesh) {
    json_t *names = json_array();
    bool *seen = array_alloc((size_t)scene->material_count + 1, sizeof *seen);
    for (uint32_t f = 0; seen && f < mesh->face_count; f++) {
        kiln_id id = mesh_face_material(mesh, f);
        if (!seen[id]) (void)json_array_append_new(names, json_text_of(scene_material(scene, id)->name));
        seen[id] = true;
        if (!mesh->face_materials) break;
    }
    free(seen);
    return names;
}

json_t *inspect_instances(const kiln_scene *scene) {
    json_t *array = json_array();
    json_t **materials = array_alloc(scene->mesh_count, sizeof *materials); /* shared by all instances of a mesh */
    for (uint32_t i = 0; materials && i < scene->mesh_count; i++)
        materials[i] = materials_of(scene, &scene->meshes[i]);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const kiln_instance *from = &scene->instances[i];
        json_t *o = json_object();
        put_text(o, "name", from->name);
        put_count(o, "mesh", from->mesh - 1);
        if (materials) put(o, "materials", json_incref(materials[from->mesh - 1]));
        put(o, "position", json_numbers_of(from->transforms[0].m + 12, 3));
        put(o, "matrix", json_numbers_of(from->transforms[0].m, 16));
        (void)json_array_append_new(array, o);
    }
    for (uint32_t i = 0; materials && i < scene->mesh_count; i++) json_decref(materials[i]);
    free(materials);
    return array;
}
