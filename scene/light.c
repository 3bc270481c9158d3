#include <float.h>

#include "scene/check.h"

kiln_light kiln_light_default(void) {
    kiln_light light = {.kind = KILN_LIGHT_POINT,
                        .color = {1, 1, 1},
                        .intensity = 1,
                        .outer_cone_rad = 0.785398163f}; /* π/4 */
    mat4 identity = mat4_identity();
    memcpy(light.transform, identity.m, sizeof light.transform);
    return light;
}

static void check_cone(kiln_light *light, const kiln_where *where, kiln_report *report) {
    const float right_angle = 1.57079633f;
    light->outer_cone_rad = check_factor(light->outer_cone_rad, 0, right_angle, right_angle / 2, "outer_cone_rad",
                                         where, report);
    light->inner_cone_rad = check_factor(light->inner_cone_rad, 0, light->outer_cone_rad, 0, "inner_cone_rad", where,
                                         report);
}

bool kiln_scene_add_light(kiln_scene *scene, const kiln_light *desc, kiln_id *id, kiln_report *report) {
    scene_place place;
    place_set(&place, scene, "light", desc->name, (size_t)scene->light_count + 1);
    const kiln_where *where = &place.where;
    kiln_light light = *desc;
    if (!check_open(scene, where, report) ||
        !check_choice(light.kind, KILN_LIGHT_DISTANT + 1, "light kind", where, report) ||
        !check_transform(light.transform, where, report))
        return false;
    for (int k = 0; k < 3; k++) light.color[k] = check_factor(light.color[k], 0, FLT_MAX, 1, "color", where, report);
    light.intensity = check_factor(light.intensity, 0, FLT_MAX, 1, "intensity", where, report);
    if (light.kind == KILN_LIGHT_SPOT) check_cone(&light, where, report);
    if (light.kind == KILN_LIGHT_DISTANT)
        light.angle_rad = check_factor(light.angle_rad, 0, 3.14159265f, 0, "angle_rad", where, report);
    if (light.kind != KILN_LIGHT_POINT && !(d3_length(d3_load(light.transform + 8)) > 0)) {
        report_warning(report, KILN_CODE_RANGE, where, "give the light's node a scale that is not 0",
                       "the transform leaves no direction to shine along: the light is dark");
        light.intensity = 0;
        mat4 upright = mat4_identity();
        memcpy(light.transform, upright.m, 12 * sizeof(double)); /* the place stays */
    }
    light.name = arena_string(&scene->arena, desc->name);
    if (!light.name) return report_no_memory(report, "building the scene");
    if (!array_room((void **)&scene->lights, scene->light_count, sizeof light, report)) return false;
    scene->lights[scene->light_count++] = light;
    if (id) *id = scene->light_count;
    return true;
}

bool kiln_scene_set_environment(kiln_scene *scene, const kiln_environment *desc, kiln_report *report) {
    kiln_where where = where_key(scene->where, "environment");
    kiln_environment environment = *desc;
    if (!check_open(scene, &where, report) ||
        !check_reference(environment.image, scene->image_count, true, "image", &where, report) ||
        !check_choice(environment.transfer, KILN_TRANSFER_COUNT, "transfer", &where, report))
        return false;
    for (int k = 0; k < 3; k++)
        environment.color[k] = check_factor(environment.color[k], 0, FLT_MAX, 1, "color", &where, report);
    if (!isfinite(environment.rotation_rad)) {
        report_warning(report, KILN_CODE_RANGE, &where, NULL, "rotation_rad is not a number: 0 is used");
        environment.rotation_rad = 0;
    }
    scene->environment = environment;
    scene->has_environment = true;
    return true;
}
