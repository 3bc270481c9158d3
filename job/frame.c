/* The nearest camera that sees everything: its position is linear in how far the scene reaches in some directions. */
#include "base/mat.h"
#include "kiln/job.h"
#include "scene/scene.h"

/* Along the normals of the view's four sides, and of its depth. */
enum { RIGHT, LEFT, UP, DOWN, NEAR, FAR, DIRECTIONS };

/* Largest p · n over the scene. */
typedef struct reach {
    dvec3 normal[DIRECTIONS];
    double most[DIRECTIONS];
} reach;

static void extend(reach *r, dvec3 p) {
    for (int k = 0; k < DIRECTIONS; k++) {
        double along = d3_dot(p, r->normal[k]);
        if (along > r->most[k]) r->most[k] = along;
    }
}

/* The mesh's own box, moved: contains the instance. */
static bool box_sticks_out(const reach *r, const kiln_mesh *m, const mat4 *transform) {
    reach box = *r;
    bool out = false;
    for (int c = 0; c < 8; c++)
        extend(&box, mat4_point(transform, (dvec3){c & 1 ? m->max[0] : m->min[0], c & 2 ? m->max[1] : m->min[1],
                                                   c & 4 ? m->max[2] : m->min[2]}));
    for (int k = 0; k < DIRECTIONS; k++) out = out || box.most[k] > r->most[k];
    return out;
}

static void extend_by_instance(reach *r, const kiln_scene *scene, const kiln_instance *instance) {
    const kiln_mesh *m = scene_mesh(scene, instance->mesh);
    size_t points = (size_t)m->vertex_count * m->time_count;
    for (uint32_t t = 0; points && t < instance->time_count; t++) {
        const mat4 *transform = &instance->transforms[t];
        if (!box_sticks_out(r, m, transform)) continue;
        for (size_t v = 0; v < points; v++) {
            const float *p = m->positions + 3 * v;
            extend(r, mat4_point(transform, (dvec3){p[0], p[1], p[2]}));
        }
    }
}

/* The eye at (x, y, z) in the camera's axes sees p when |p.x − x| ≤ tx (z − p.z), and the same for y. So x + tx z must
 * reach the most that p.x + tx p.z does, and −x + tx z the most of −p.x + tx p.z; between both, all is centred. */
static dvec3 place_eye(const reach *r, double tx, double ty) {
    const double *m = r->most;
    double z = fmax((m[RIGHT] + m[LEFT]) / (2 * tx), (m[UP] + m[DOWN]) / (2 * ty));
    /* A point, or a line towards the eye, would leave it no distance; 1e-12 of the coordinates are rounding errors. */
    double depth = m[NEAR] + m[FAR], clear = z - m[NEAR];
    if (!(clear > 1e-3 * depth + 1e-12 * fabs(m[NEAR]))) z = m[NEAR] + (depth > 0 ? depth : 1);
    return (dvec3){(m[RIGHT] - m[LEFT]) / 2, (m[UP] - m[DOWN]) / 2, z};
}

kiln_camera kiln_camera_frame(const kiln_scene *scene, const kiln_framing *f) {
    double yfov = f->yfov_rad > 0 ? f->yfov_rad : M_PI / 6, fit = f->fit > 0 ? f->fit : 0.85;
    double ty = fit * tan(yfov / 2), tx = ty * (f->aspect > 0 ? f->aspect : 1);
    double ca = cos(f->azimuth_rad), sa = sin(f->azimuth_rad), ce = cos(f->elevation_rad), se = sin(f->elevation_rad);
    dvec3 right = {ca, 0, -sa}, back = {sa * ce, se, ca * ce}, up = d3_cross(back, right);
    reach r = {.normal = {d3_add(d3_scale(back, tx), right), d3_sub(d3_scale(back, tx), right),
                          d3_add(d3_scale(back, ty), up), d3_sub(d3_scale(back, ty), up), back, d3_scale(back, -1)}};
    for (int k = 0; k < DIRECTIONS; k++) r.most[k] = -INFINITY;
    for (uint32_t i = 0; i < scene->instance_count; i++) extend_by_instance(&r, scene, &scene->instances[i]);
    if (!(r.most[NEAR] > -INFINITY)) extend(&r, (dvec3){0, 0, 0}); /* nothing to see: from a metre away */
    dvec3 at = place_eye(&r, tx, ty);
    dvec3 eye = d3_add(d3_add(d3_scale(right, at.x), d3_scale(up, at.y)), d3_scale(back, at.z));
    kiln_camera camera = kiln_camera_default();
    camera.yfov_rad = yfov;
    const mat4 frame = {
        {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0, eye.x, eye.y, eye.z, 1}};
    memcpy(camera.transform, frame.m, sizeof frame.m);
    return camera;
}
