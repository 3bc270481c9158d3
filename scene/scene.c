#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>

#include "scene/bounds.h"
#include "scene/check.h"
#include "scene/material.h"

kiln_scene *kiln_scene_create(void) {
    kiln_scene *scene = calloc(1, sizeof *scene);
    if (!scene) return NULL;
    scene->default_material = kiln_material_default();
    scene->bounds = bounds_empty();
    return scene;
}

void kiln_scene_destroy(kiln_scene *scene) {
    if (!scene) return;
    for (uint32_t i = 0; i < scene->image_count; i++)
        if (scene->images[i].release) scene->images[i].release(scene->images[i].release_user);
    for (uint32_t i = 0; i < scene->mesh_count; i++) arena_free(&scene->meshes[i].arena);
    free(scene->images);
    free(scene->materials);
    free(scene->meshes);
    free(scene->instances);
    free(scene->lights);
    free(scene->cameras);
    arena_free(&scene->arena);
    free(scene);
}

kiln_scene_counts kiln_scene_count(const kiln_scene *scene) {
    kiln_scene_counts counts = {.images = scene->image_count,
                                .materials = scene->material_count,
                                .meshes = scene->mesh_count,
                                .instances = scene->instance_count,
                                .lights = scene->light_count,
                                .cameras = scene->camera_count,
                                .has_environment = scene->has_environment};
    for (uint32_t i = 0; i < scene->mesh_count; i++) counts.triangles_unique += scene->meshes[i].triangle_count;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        counts.triangles += scene_mesh(scene, scene->instances[i].mesh)->triangle_count;
    return counts;
}

kiln_bounds kiln_scene_bounds(const kiln_scene *scene) { return scene->bounds; }

const kiln_camera *kiln_scene_camera(const kiln_scene *scene, kiln_id id) {
    return id && id <= scene->camera_count ? &scene->cameras[id - 1] : NULL;
}

/* One warning for each UV set that a material reads and a mesh does not have. */
static void check_uv_sets(const kiln_scene *scene, const kiln_mesh *mesh, const kiln_material *material,
                          kiln_report *report) {
    const kiln_texture *textures[KILN_MATERIAL_TEXTURES];
    uint32_t count = material_textures(material, textures);
    for (uint32_t t = 0; t < count; t++) {
        bool known = mesh_primvar(mesh, KILN_PRIMVAR_UV, textures[t]->uv_set);
        for (uint32_t before = 0; before < t; before++) known |= textures[before]->uv_set == textures[t]->uv_set;
        if (known) continue;
        scene_place place;
        place_set(&place, scene, "mesh", mesh->name, (size_t)(mesh - scene->meshes) + 1);
        report_warning(report, KILN_CODE_GEOMETRY, &place.where, "unwrap the mesh, or drop the texture",
                       "UV set %u, which a texture of material '%s' reads, does not exist: (0, 0) is used",
                       textures[t]->uv_set, material->name);
    }
}

static bool check_materials_of(const kiln_scene *scene, const kiln_mesh *mesh, kiln_report *report) {
    bool *seen = array_alloc((size_t)scene->material_count + 1, sizeof *seen);
    if (!seen) return report_no_memory(report, "checking the scene");
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        kiln_id id = mesh_face_material(mesh, f);
        if (seen[id]) continue;
        seen[id] = true;
        check_uv_sets(scene, mesh, scene_material(scene, id), report);
        if (!mesh->face_materials) break;
    }
    free(seen);
    return true;
}

bool kiln_scene_commit(kiln_scene *scene, kiln_report *report) {
    if (!check_open(scene, scene->where, report)) return false;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        if (!check_materials_of(scene, &scene->meshes[i], report)) return false;
    if (!bounds_of_scene(scene, &scene->bounds, report)) return false;
    scene->where = NULL; /* the importer's chain does not outlive it */
    scene->committed = true;
    return true;
}

const char *scene_name(kiln_arena *arena, const char *name, const char *prefix, kiln_id handle) {
    char text[32];
    if (name && *name) return name;
    snprintf(text, sizeof text, "%s%u", prefix, handle);
    return arena_string(arena, text);
}
