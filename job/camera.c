#include "job/camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mat.h"
#include "scene/scene.h"

static const double degree = M_PI / 180;

/* The longer side of a picture whose size nobody gave. */
enum { DEFAULT_SIDE = 1024, SIDE_MAX = 65536 };

double camera_lens_radius(double f_stop, double yfov_rad) {
    const double half_sensor = 0.012; /* metres; 36 × 24 mm */
    return f_stop > 0 ? half_sensor / tan(yfov_rad / 2) / (2 * f_stop) : 0;
}

double camera_azimuth(const kiln_camera *c) {
    const double *back = c->transform + 8, *up = c->transform + 4;
    bool vertical = fabs(back[0]) + fabs(back[2]) < 1e-6 * fabs(back[1]);
    /* From above, where the lower edge of the picture is. */
    return vertical ? atan2(-up[0], -up[2]) : atan2(back[0], back[2]);
}

static bool no_such_camera(const kiln_scene *scene, const char *wanted, kiln_report *report) {
    kiln_where where = where_root("--camera");
    kiln_text remedy = {0};
    text_append(&remedy, scene->camera_count ? "give auto or one of" : "leave it out: auto frames the scene");
    for (uint32_t i = 0; i < scene->camera_count && i < 20; i++) {
        const char *name = scene->cameras[i].name;
        text_format(&remedy, "%s %u", i ? "," : "", i);
        if (*name) text_format(&remedy, " '%.60s'", name);
    }
    report_error(report, KILN_CODE_USAGE, &where, remedy.data, "the scene has no camera '%s'", wanted);
    text_free(&remedy);
    return false;
}

/* *found NULL: auto. A name goes before a number. */
static bool find_camera(const job_options *o, const kiln_scene *scene, const kiln_camera **found, kiln_report *report) {
    *found = NULL;
    if (!o->camera) {
        bool framed = job_given(o, orbit) || job_given(o, frame_fit);
        if (!framed && scene->camera_count) *found = &scene->cameras[0];
        return true;
    }
    for (uint32_t i = 0; i < scene->camera_count && !*found; i++)
        if (strcmp(scene->cameras[i].name, o->camera) == 0) *found = &scene->cameras[i];
    uint64_t index;
    if (!*found && text_to_uint64(o->camera, &index) && index < scene->camera_count) *found = &scene->cameras[index];
    if (!*found && strcmp(o->camera, "auto") == 0) return true;
    return *found || no_such_camera(scene, o->camera, report);
}

static void choose_size(const job_options *o, const kiln_camera *c, job_view *v) {
    v->width = o->size[0] ? o->size[0] : DEFAULT_SIDE;
    v->height = o->size[1] ? o->size[1] : DEFAULT_SIDE;
    if (o->size[0] || !c || !(c->aspect > 0)) return;
    double shorter = fmax(round(DEFAULT_SIDE * (c->aspect > 1 ? 1 / c->aspect : c->aspect)), 1);
    *(c->aspect > 1 ? &v->height : &v->width) = (uint32_t)shorter;
}

static bool refuse(const char *flag, const char *why, const char *remedy, kiln_report *report) {
    kiln_where where = where_root(flag);
    return report_error(report, KILN_CODE_USAGE, &where, remedy, "%s", why);
}

static bool change_lens(const job_options *o, kiln_camera *c, kiln_report *report) {
    bool flat = c->projection == KILN_ORTHOGRAPHIC;
    if (flat && job_given(o, fov_deg))
        return refuse("--fov", "the camera is orthographic: it has no angle of view", "choose another camera", report);
    if (flat && o->aperture > 0)
        return refuse("--aperture", "the camera is orthographic: it has no focal length", "choose another camera",
                      report);
    if (job_given(o, fov_deg)) c->yfov_rad = o->fov_deg * degree;
    if (job_given(o, aperture)) c->lens_radius = camera_lens_radius(o->aperture, c->yfov_rad);
    if (job_given(o, focus)) c->focus_distance = o->focus;
    if (job_given(o, blades)) c->blades = o->blades;
    if (o->blades == 1 || o->blades == 2)
        return refuse("--blades", "one or two blades enclose nothing", "give 3 or more, or 0 for a round aperture",
                      report);
    return true;
}

static kiln_camera frame(const job_options *o, const kiln_scene *scene, const job_view *v) {
    return kiln_camera_frame(scene, &(kiln_framing){.azimuth_rad = o->orbit.azimuth_deg * degree,
                                                    .elevation_rad = o->orbit.elevation_deg * degree,
                                                    .yfov_rad = o->fov_deg * degree,
                                                    .aspect = (double)v->width / v->height,
                                                    .fit = o->frame_fit});
}

static bool name_view(const kiln_scene *scene, const kiln_camera *from, job_view *v, kiln_report *report) {
    kiln_text name = {0};
    if (!from) text_append(&name, "auto");
    else if (*from->name) text_append(&name, from->name);
    else text_format(&name, "%zu", (size_t)(from - scene->cameras));
    v->name = text_take(&name);
    return v->name || report_no_memory(report, "choosing a camera");
}

bool view_choose(const job_options *o, const kiln_scene *scene, job_view *v, kiln_report *report) {
    *v = (job_view){0};
    const kiln_camera *from;
    if (!find_camera(o, scene, &from, report)) return false;
    if (from && (job_given(o, orbit) || job_given(o, frame_fit)))
        return refuse(job_given(o, orbit) ? "--orbit" : "--frame-fit", "it belongs to the camera auto",
                      "leave out --camera, or give --camera auto", report);
    v->automatic = !from;
    choose_size(o, from, v);
    v->camera = from ? *from : frame(o, scene, v);
    v->camera.name = NULL; /* borrowed: v->name says it */
    return change_lens(o, &v->camera, report) && name_view(scene, from, v, report);
}

void view_reframe(const job_options *o, const kiln_scene *scene, job_view *v) {
    if (!v->automatic) return;
    kiln_camera again = frame(o, scene, v);
    memcpy(v->camera.transform, again.transform, sizeof again.transform);
}
