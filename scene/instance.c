#include "scene/check.h"

static bool check_transforms(kiln_instance *instance, mat4 *transforms, const kiln_where *where, kiln_report *report) {
    for (uint32_t t = 0; t < instance->time_count; t++) {
        if (!check_transform(transforms[t].m, where, report)) return false;
        mat4 inverse;
        if (!mat4_invert(&transforms[t], &inverse)) instance->flat = true;
    }
    if (instance->flat)
        report_warning(report, KILN_CODE_RANGE, where, NULL, "the transform is singular: the instance is flat");
    return true;
}

bool kiln_scene_add_instance(kiln_scene *scene, const kiln_instance_desc *desc, kiln_id *id, kiln_report *report) {
    scene_place place;
    place_set(&place, scene, "instance", desc->name, (size_t)scene->instance_count + 1);
    if (!check_open(scene, &place.where, report) ||
        !check_reference(desc->mesh, scene->mesh_count, false, "mesh", &place.where, report))
        return false;
    bool moves = desc->time_count > 1 && desc->transforms;
    kiln_instance instance = {.mesh = desc->mesh, .time_count = moves ? desc->time_count : 1};
    if (!check_time_count(instance.time_count, &place.where, report)) return false;
    mat4 *transforms = ARENA_ARRAY(&scene->arena, mat4, instance.time_count);
    instance.name = arena_string(&scene->arena, desc->name);
    instance.asset = arena_string(&scene->arena, desc->asset);
    if (!transforms || !instance.name || !instance.asset) return report_no_memory(report, "building the scene");
    if (desc->transforms) memcpy(transforms, desc->transforms, instance.time_count * sizeof *transforms);
    else transforms[0] = mat4_identity();
    instance.transforms = transforms;
    if (!check_transforms(&instance, transforms, &place.where, report) ||
        !array_room((void **)&scene->instances, scene->instance_count, sizeof instance, report))
        return false;
    scene->instances[scene->instance_count++] = instance;
    if (id) *id = scene->instance_count;
    return true;
}
