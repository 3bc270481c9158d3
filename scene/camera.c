#include "scene/check.h"

kiln_camera kiln_camera_default(void) {
    kiln_camera camera = {.projection = KILN_PERSPECTIVE,
                          .yfov_rad = 0.69813170079773183, /* 40° */
                          .xmag = 1,
                          .ymag = 1};
    mat4 identity = mat4_identity();
    memcpy(camera.transform, identity.m, sizeof camera.transform);
    return camera;
}

static bool refuse(const char *what, double value, const char *domain, const kiln_where *where, kiln_report *report) {
    return report_error(report, KILN_CODE_RANGE, where, domain, "%s is %g", what, value);
}

static bool check_projection(kiln_camera *c, const kiln_where *where, kiln_report *report) {
    if (c->projection == KILN_PERSPECTIVE) {
        if (!(c->yfov_rad > 0 && c->yfov_rad < 3.14159265358979))
            return refuse("yfov_rad", c->yfov_rad, "the vertical angle must lie between 0 and π", where, report);
        return true;
    }
    c->xmag = fabs(c->xmag); /* glTF: negative values should not be used; they do not mirror here */
    c->ymag = fabs(c->ymag);
    if (!(c->xmag > 0 && isfinite(c->xmag)))
        return refuse("xmag", c->xmag, "half the width must be positive", where, report);
    if (!(c->ymag > 0 && isfinite(c->ymag)))
        return refuse("ymag", c->ymag, "half the height must be positive", where, report);
    return true;
}

/* A lens that is not one becomes a pinhole or round, with a warning; what decides where the picture is, is refused. */
static void check_lens(kiln_camera *c, const kiln_where *where, kiln_report *report) {
    struct { const char *name; double *value; } rows[] = {{"lens_radius", &c->lens_radius},
                                                          {"focus_distance", &c->focus_distance}};
    for (int i = 0; i < 2; i++)
        if (!(*rows[i].value >= 0 && isfinite(*rows[i].value))) {
            report_warning(report, KILN_CODE_RANGE, where, NULL, "%s is %g: 0 is used", rows[i].name, *rows[i].value);
            *rows[i].value = 0;
        }
    if (c->blades == 1 || c->blades == 2) {
        report_warning(report, KILN_CODE_RANGE, where, NULL, "%u blades enclose nothing: the aperture is round",
                       c->blades);
        c->blades = 0;
    }
    if (!isfinite(c->blade_rotation_rad)) {
        report_warning(report, KILN_CODE_RANGE, where, NULL, "blade_rotation_rad is not a number: 0 is used");
        c->blade_rotation_rad = 0;
    }
}

static bool check_ranges(kiln_camera *c, const kiln_where *where, kiln_report *report) {
    if (!(c->aspect >= 0 && isfinite(c->aspect)))
        return refuse("aspect", c->aspect, "give width / height, or 0 for the picture's", where, report);
    if (!(c->znear >= 0 && isfinite(c->znear)))
        return refuse("znear", c->znear, "the near distance must not be negative", where, report);
    if (c->zfar == HUGE_VAL) c->zfar = 0;
    if (c->zfar != 0 && !(c->zfar > c->znear))
        return refuse("zfar", c->zfar, "the far distance must lie behind the near one", where, report);
    if (!isfinite(c->shutter_open) || !isfinite(c->shutter_close) || c->shutter_close < c->shutter_open)
        return refuse("shutter_close", c->shutter_close, "the shutter must close after it opens", where, report);
    return true;
}

bool kiln_scene_add_camera(kiln_scene *scene, const kiln_camera *desc, kiln_id *id, kiln_report *report) {
    scene_place place;
    place_set(&place, scene, "camera", desc->name, (size_t)scene->camera_count + 1);
    kiln_camera camera = *desc;
    if (!check_open(scene, &place.where, report) || !camera_check(&camera, &place.where, report)) return false;
    camera.name = arena_string(&scene->arena, desc->name);
    if (!camera.name) return report_no_memory(report, "building the scene");
    if (!array_room((void **)&scene->cameras, scene->camera_count, sizeof camera, report)) return false;
    scene->cameras[scene->camera_count++] = camera;
    if (id) *id = scene->camera_count;
    return true;
}

bool camera_check(kiln_camera *camera, const kiln_where *where, kiln_report *report) {
    if (!check_choice(camera->projection, KILN_ORTHOGRAPHIC + 1, "projection", where, report) ||
        !check_transform(camera->transform, where, report) || !check_projection(camera, where, report) ||
        !check_ranges(camera, where, report))
        return false;
    check_lens(camera, where, report);
    mat4 transform = mat4_load(camera->transform);
    if (mat4_determinant(&transform) == 0)
        return report_error(report, KILN_CODE_RANGE, where, "give the camera's node a scale that is not 0",
                            "the transform flattens the camera");
    return true;
}
