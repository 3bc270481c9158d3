#include "job/lighting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/image.h"
#include "job/camera.h"
#include "scene/scene.h"

/* Emission up to 1 is how glTF draws things that glow; only what was made brighter than that (by
 * KHR_materials_emissive_strength, or in a scene made by a program) may be meant to light others. */
static bool is_lamp(const kiln_material *m) {
    bool bright = m->emission.value[0] > 1 || m->emission.value[1] > 1 || m->emission.value[2] > 1;
    return bright && !(m->layers & KILN_LAYER_UNLIT);
}

static bool has_lamp(const kiln_scene *scene, const kiln_mesh *mesh) {
    if (!mesh->face_materials) return mesh->face_count && is_lamp(scene_material(scene, mesh->material));
    for (uint32_t f = 0; f < mesh->face_count; f++)
        if (is_lamp(scene_material(scene, mesh_face_material(mesh, f)))) return true;
    return false;
}

static bool any_lamp(const kiln_scene *scene) {
    bool possible = false;
    for (uint32_t i = 0; i <= scene->material_count; i++) possible = possible || is_lamp(scene_material(scene, i));
    for (uint32_t i = 0; possible && i < scene->instance_count; i++)
        if (has_lamp(scene, scene_mesh(scene, scene->instances[i].mesh))) return true;
    return false;
}

static bool any_punctual(const kiln_scene *scene) {
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const kiln_light *l = &scene->lights[i];
        if (l->intensity > 0 && (l->color[0] > 0 || l->color[1] > 0 || l->color[2] > 0)) return true;
    }
    return false;
}

job_lighting lighting_choose(const job_options *o, const kiln_scene *scene) {
    job_lighting l = {.punctual = any_punctual(scene), .emissive = any_lamp(scene)};
    bool certain = l.punctual || scene->has_environment;
    l.doubtful = !o->env && !certain && l.emissive;
    if (!o->env) l.kind = certain || l.doubtful ? JOB_LIGHT_SCENE : JOB_LIGHT_STUDIO;
    else if (strcmp(o->env, "none") == 0) l.kind = JOB_LIGHT_NONE;
    else l.kind = strcmp(o->env, "studio") == 0 ? JOB_LIGHT_STUDIO : JOB_LIGHT_FILE;
    return l;
}

const char *lighting_describe(const job_lighting *l, const job_options *o) {
    bool own = l->punctual || l->emissive;
    switch (l->kind) {
    case JOB_LIGHT_SCENE: return "the scene's own";
    case JOB_LIGHT_FILE: return path_base(o->env);
    case JOB_LIGHT_STUDIO: return l->dim ? "studio (the scene's emitters alone would leave it dark)" : "studio";
    case JOB_LIGHT_NONE: return own ? "the scene's own, no surroundings" : "none";
    }
    return "";
}

static void release_bytes(void *user) {
    file_free(user);
    free(user);
}

static bool read_picture(const char *path, kiln_scene *scene, kiln_environment *environment, kiln_report *report) {
    const uint64_t limit = (uint64_t)4 << 30;
    kiln_where where = where_root(path);
    kiln_image_info info;
    kiln_bytes *bytes = calloc(1, sizeof *bytes);
    if (!bytes) return report_no_memory(report, "reading the environment");
    if (!file_read(path, limit, bytes, NULL, report) || !image_probe(bytes->data, bytes->size, &info, &where, report)) {
        release_bytes(bytes);
        return false;
    }
    if (info.width != 2 * info.height)
        report_warning(report, KILN_CODE_IMAGE, &where, "give a latitude-longitude picture",
                       "the environment has %u x %u pixels: twice as wide as high is expected", info.width,
                       info.height);
    environment->transfer = info.format == KILN_PIXELS_F32 ? KILN_TRANSFER_LINEAR : KILN_TRANSFER_SRGB;
    kiln_image_desc image = {.name = path, .encoded = bytes->data, .encoded_size = bytes->size,
                             .release = release_bytes, .release_user = bytes};
    return kiln_scene_add_image(scene, &image, &environment->image, report);
}

bool lighting_apply(const job_lighting *l, const job_options *o, const kiln_camera *camera, kiln_scene *scene,
                    kiln_report *report) {
    double turned = o->env_rotate_deg * M_PI / 180;
    kiln_environment file = {.rotation_rad = turned};
    for (int k = 0; k < 3; k++) file.color[k] = (float)o->env_intensity;
    switch (l->kind) {
    case JOB_LIGHT_SCENE: /* an environment that the scene has is turned further, and multiplied */
        scene->environment.rotation_rad += turned;
        for (int k = 0; k < 3; k++) scene->environment.color[k] *= (float)o->env_intensity;
        return true;
    case JOB_LIGHT_FILE:
        return read_picture(o->env, scene, &file, report) && kiln_scene_set_environment(scene, &file, report);
    case JOB_LIGHT_STUDIO:
        return kiln_scene_set_studio(scene, camera_azimuth(camera) + turned, o->env_intensity, report);
    case JOB_LIGHT_NONE: scene->has_environment = false; return true;
    }
    return true;
}
