#include "render/path/camera.h"

#include "render/accel/accel.h"

/* The camera's axes without scale; a camera that was flattened keeps what is left of it. */
static void set_frame(camera *c, const kiln_camera *from) {
    dvec3 back = d3_normalize(d3_load(from->transform + 8)), up = d3_load(from->transform + 4);
    if (!(d3_length(back) > 0)) back = (dvec3){0, 0, 1};
    dvec3 right = d3_normalize(d3_cross(up, back));
    if (!(d3_length(right) > 0)) right = d3_normalize(d3_cross(fabs(back.y) < 0.9 ? (dvec3){0, 1, 0} : (dvec3){1, 0, 0}, back));
    c->right = to_float(right);
    c->up = to_float(d3_cross(back, right));
    c->back = to_float(back);
}

/* Distance along the axis to what the middle of the picture sees; the scene's size when it sees nothing. */
static float focus_on_middle(const world *w, const camera *c) {
    vec3 d = v3_neg(c->back);
    float t, u, v;
    uint32_t triangle, instance;
    trace_counts counts = {0};
    ray_lanes ray = {&c->origin.x, &c->origin.y, &c->origin.z, &d.x, &d.y, &d.z, &c->near, &c->far, {0}, NULL, 1};
    accel_closest(w, &ray, &t, &u, &v, &triangle, &instance, &counts);
    return triangle < TRIANGLE_REFUSED && t > 0 ? t : fmaxf(v3_length(c->origin), w->radius);
}

bool camera_make(const world *w, const kiln_camera *from, uint32_t width, uint32_t height, camera *c, kiln_report *report) {
    kiln_camera checked = *from;
    kiln_where where = where_root("camera");
    if (!camera_check(&checked, &where, report)) return false;
    from = &checked;
    *c = (camera){.origin = to_float(world_point(w, d3_load(from->transform + 12)))};
    set_frame(c, from);
    double aspect = (double)width / (double)height;
    c->orthographic = from->projection == KILN_ORTHOGRAPHIC ? 1.0f : 0.0f;
    double half_height = from->projection == KILN_ORTHOGRAPHIC ? from->ymag * w->scale : tan(0.5 * from->yfov_rad);
    c->half_height = (float)half_height;
    c->half_width = (float)(half_height * aspect);
    c->near = (float)fmax(from->znear * w->scale, 0);
    c->far = from->zfar > 0 ? (float)(from->zfar * w->scale) : INFINITY;
    c->lens_radius = (float)(from->lens_radius * w->scale);
    c->blades = from->blades >= 3 ? (float)from->blades : 0.0f;
    c->blade_rotation_turns = to_turns(from->blade_rotation_rad);
    c->focus = from->focus_distance > 0 ? (float)(from->focus_distance * w->scale) : 1.0f;
    if (c->lens_radius > 0 && !(from->focus_distance > 0)) c->focus = focus_on_middle(w, c);
    return true;
}
