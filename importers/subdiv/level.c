#include "importers/subdiv/level.h"

#include <stdlib.h>

view_scale view_of_camera(const kiln_camera *camera, uint32_t height) {
    if (!camera || !height) return (view_scale){0};
    view_scale view = {.present = true, .orthographic = camera->projection == KILN_ORTHOGRAPHIC,
                       .eye = d3_load(camera->transform + 12)};
    view.pixels = view.orthographic ? height / (2 * camera->ymag) : height / (2 * tan(camera->yfov_rad / 2));
    return view;
}

/* Of a length at a place. Nothing counts as nearer than it is long, so that edges beside the eye stay finite. */
static double pixels_of(const view_scale *view, dvec3 place, double length) {
    if (view->orthographic) return view->pixels * length;
    double distance = d3_length(d3_sub(place, view->eye));
    distance = distance > length ? distance : length;
    return distance > 0 ? view->pixels * length / distance : 0;
}

/* The diagonal of the mesh's box, at the point of the box's sphere that is nearest to the eye. */
static double instance_pixels(const kiln_mesh *m, const mat4 *transform, const view_scale *view) {
    dvec3 low = {m->min[0], m->min[1], m->min[2]}, high = {m->max[0], m->max[1], m->max[2]};
    double diagonal = d3_length(mat4_vector(transform, d3_sub(high, low)));
    dvec3 middle = mat4_point(transform, d3_scale(d3_add(low, high), 0.5));
    dvec3 towards = d3_sub(view->eye, middle);
    double distance = d3_length(towards), step = distance < diagonal / 2 ? distance : diagonal / 2;
    return pixels_of(view, d3_add(middle, d3_scale(d3_normalize(towards), step)), diagonal);
}

mat4 *level_largest_instances(const kiln_scene *scene, const view_scale *view) {
    mat4 *placements = array_alloc(scene->mesh_count, sizeof *placements);
    double *largest = array_alloc(scene->mesh_count, sizeof *largest);
    for (uint32_t i = 0; placements && largest && i < scene->instance_count; i++) {
        const kiln_instance *instance = &scene->instances[i];
        const kiln_mesh *m = scene_mesh(scene, instance->mesh);
        for (uint32_t t = 0; m->vertex_count && t < instance->time_count; t++) {
            double pixels = instance_pixels(m, &instance->transforms[t], view);
            if (!(pixels > largest[instance->mesh - 1])) continue;
            largest[instance->mesh - 1] = pixels;
            placements[instance->mesh - 1] = instance->transforms[t];
        }
    }
    bool ok = placements && largest;
    free(largest);
    if (ok) return placements;
    free(placements);
    return NULL;
}

static int compare(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double quantile99(float *values, uint32_t count) {
    qsort(values, count, sizeof *values, compare);
    return count ? (double)values[(uint32_t)(0.99 * (count - 1))] : 0;
}

static dvec3 load(const float *p) { return (dvec3){p[0], p[1], p[2]}; }

double level_edge_pixels(const kiln_cage *c, const mat4 *placement, const view_scale *view) {
    float *pixels = array_alloc(c->corner_count, sizeof *pixels);
    if (!pixels) return -1;
    for (uint32_t f = 0, first = 0; f < c->face_count; first += c->face_sizes[f++])
        for (uint32_t k = 0, size = c->face_sizes[f]; k < size; k++) {
            dvec3 a = mat4_point(placement, load(c->positions + 3 * (size_t)c->face_vertices[first + k]));
            dvec3 b = mat4_point(placement, load(c->positions + 3 * (size_t)c->face_vertices[first + (k + 1) % size]));
            pixels[first + k] = (float)pixels_of(view, d3_scale(d3_add(a, b), 0.5), d3_length(d3_sub(a, b)));
        }
    double result = quantile99(pixels, c->corner_count);
    free(pixels);
    return result;
}

/* Refining halves an edge and quarters the distance of the chord's middle from the curve. */
static double level_of_edge(double edge_pixels, double chord_pixels) {
    const double chord_max = 0.1;
    double by_length = log2(edge_pixels), by_chord = log2(chord_pixels / chord_max) / 2;
    return by_length < by_chord ? by_length : by_chord;
}

uint32_t level_for_view(const kiln_cage *c, const osd_surface *s, const mat4 *placement, const view_scale *view) {
    float *levels = array_alloc(c->corner_count, sizeof *levels);
    if (!levels) return 0;
    uint32_t count = 0, n = s->face_size;
    for (uint32_t f = 0, first = 0; f < c->face_count; first += c->face_sizes[f++])
        for (uint32_t k = 0, size = c->face_sizes[f]; k < size; k++) {
            uint32_t here = s->cage_corners[first + k], there = s->cage_corners[first + (k + 1) % size];
            if (here == UINT32_MAX || there == UINT32_MAX) continue;
            uint32_t between = here / n * n + (here + 1) % n; /* the next corner of the child is the edge's middle */
            dvec3 a = mat4_point(placement, load(s->positions + 3 * (size_t)s->face_vertices[here]));
            dvec3 b = mat4_point(placement, load(s->positions + 3 * (size_t)s->face_vertices[there]));
            dvec3 curve = mat4_point(placement, load(s->positions + 3 * (size_t)s->face_vertices[between]));
            dvec3 chord = d3_scale(d3_add(a, b), 0.5);
            double edge_pixels = pixels_of(view, chord, d3_length(d3_sub(a, b)));
            double chord_pixels = pixels_of(view, chord, d3_length(d3_sub(curve, chord)));
            double level = level_of_edge(edge_pixels, chord_pixels);
            levels[count++] = level >= 0 && level <= LEVEL_MAX ? (float)level : level > LEVEL_MAX ? LEVEL_MAX : 0;
        }
    double level = ceil(quantile99(levels, count));
    free(levels);
    return level < 1 ? 1 : (uint32_t)level;
}
