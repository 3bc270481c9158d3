#include "scene/bounds.h"

#include <stdlib.h>

#include "scene/check.h"

static void extend_axis(kiln_bounds *b, int axis, double x) {
    if (!(x >= b->min[axis])) b->min[axis] = x; /* so that NaN enters and is found */
    if (!(x <= b->max[axis])) b->max[axis] = x;
}
static void extend(kiln_bounds *b, dvec3 p) {
    extend_axis(b, 0, p.x);
    extend_axis(b, 1, p.y);
    extend_axis(b, 2, p.z);
}

/* The eight corners of the mesh's own box, moved: contains the instance, but may be larger. */
static kiln_bounds loose_box(const kiln_scene *scene, const kiln_instance *instance) {
    const kiln_mesh *mesh = scene_mesh(scene, instance->mesh);
    kiln_bounds box = bounds_empty();
    if (!mesh->vertex_count) return box;
    for (uint32_t t = 0; t < instance->time_count; t++)
        for (int c = 0; c < 8; c++) {
            dvec3 corner = {c & 1 ? mesh->max[0] : mesh->min[0], c & 2 ? mesh->max[1] : mesh->min[1],
                            c & 4 ? mesh->max[2] : mesh->min[2]};
            extend(&box, mat4_point(&instance->transforms[t], corner));
        }
    return box;
}

/* Between two time samples points and transforms are interpolated linearly, so that every position is a mean of
 * (transform i) × (point j): all pairs bound them. */
static void extend_exactly(const kiln_scene *scene, const kiln_instance *instance, kiln_bounds *bounds) {
    const kiln_mesh *mesh = scene_mesh(scene, instance->mesh);
    size_t points = (size_t)mesh->vertex_count * mesh->time_count;
    for (uint32_t t = 0; t < instance->time_count; t++)
        for (size_t v = 0; v < points; v++) {
            const float *p = mesh->positions + 3 * v;
            extend(bounds, mat4_point(&instance->transforms[t], (dvec3){p[0], p[1], p[2]}));
        }
}

static bool inside(const kiln_bounds *inner, const kiln_bounds *outer) {
    for (int k = 0; k < 3; k++)
        if (inner->min[k] < outer->min[k] || inner->max[k] > outer->max[k]) return false;
    return true;
}

static bool finite_box(const kiln_scene *scene, uint32_t i, const kiln_bounds *box, kiln_report *report) {
    for (int k = 0; k < 3; k++)
        if (scene_mesh(scene, scene->instances[i].mesh)->vertex_count &&
            !(isfinite(box->min[k]) && isfinite(box->max[k]) && isfinite(box->max[k] - box->min[k]))) {
            scene_place place;
            place_set(&place, scene, "instance", scene->instances[i].name, i + 1);
            return report_error(report, KILN_CODE_RANGE, &place.where, "bring the transform to a sensible scale",
                                "its world positions are not finite numbers");
        }
    return true;
}

/* Instances in the middle of a scene cannot move its box, so the outermost ones go first, and of the rest only those
 * whose loose box sticks out are looked at point by point: a forest of a million trees costs a million boxes. */
bool bounds_of_scene(const kiln_scene *scene, kiln_bounds *bounds, kiln_report *report) {
    kiln_bounds *boxes = array_alloc(scene->instance_count, sizeof *boxes);
    if (!boxes) return report_no_memory(report, "measuring the scene");
    uint32_t outermost[6] = {0};
    bool ok = true;
    for (uint32_t i = 0; i < scene->instance_count && ok; i++) {
        boxes[i] = loose_box(scene, &scene->instances[i]);
        ok = finite_box(scene, i, &boxes[i], report);
        for (int k = 0; k < 3; k++) {
            if (boxes[i].min[k] < boxes[outermost[k]].min[k]) outermost[k] = i;
            if (boxes[i].max[k] > boxes[outermost[3 + k]].max[k]) outermost[3 + k] = i;
        }
    }
    *bounds = bounds_empty();
    for (int k = 0; k < 6 && ok && scene->instance_count; k++)
        if (!inside(&boxes[outermost[k]], bounds)) extend_exactly(scene, &scene->instances[outermost[k]], bounds);
    for (uint32_t i = 0; i < scene->instance_count && ok; i++)
        if (!inside(&boxes[i], bounds)) extend_exactly(scene, &scene->instances[i], bounds);
    free(boxes);
    return ok;
}
