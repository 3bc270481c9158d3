#include "importers/subdiv/decide.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/mat.h"
#include "base/text.h"
#include "importers/subdiv/edges.h"

#define DEGREE 0.017453292519943295
/* Tuned on the meshes of about fifty glTF models. Spheres, hoses and lenses deviate by 0.01 to 0.06 %, with normals
 * within 7°; what has bevels, panels, or averaged normals on hard shapes, by 0.2 % and more, or has normals that are off
 * by 9° and more. A thousandth of the bounds is a pixel in a picture that the model fills. */
static const double SPLIT_MAX = 0.02;
static const double NORMAL_MAX_RAD = 7.5 * DEGREE;
static const double DEVIATION_MAX = 0.001, DEVIATION_WORST = 0.002;
static const double SLIDE_MAX = 0.015;
static const double BULGE_MAX = 0.01, BULGE_MIN = 1e-5;

typedef struct comparison {
    const kiln_mesh *mesh;
    const kiln_primvar *normals;
    const kiln_cage *cage;
    const osd_surface *once;
    edge_table edges; /* of the cage */
} comparison;

static dvec3 load(const float *p) { return (dvec3){p[0], p[1], p[2]}; }

/* In radians; π where one of them is zero. */
static double angle_between(dvec3 a, dvec3 b) {
    double sine = d3_length(d3_cross(a, b)), cosine = d3_dot(a, b);
    return sine == 0 && cosine == 0 ? 3.14159265358979323846 : atan2(sine, cosine);
}

/* What the file says at a corner of the cage, which itself may have moved. */
static dvec3 authored_point(const comparison *c, uint32_t corner) {
    return load(c->mesh->positions + 3 * (size_t)c->mesh->face_vertices[c->cage->corner_sources[corner]]);
}
static dvec3 authored_normal(const comparison *c, uint32_t face, uint32_t corner) {
    uint32_t source = c->cage->corner_sources[corner];
    uint32_t source_face = c->cage->face_sources[face], vertex = c->mesh->face_vertices[source];
    return d3_normalize(load(primvar_at(c->normals, source_face, source, vertex)));
}

static dvec3 limit_point(const comparison *c, uint32_t corner) {
    return load(c->once->positions + 3 * (size_t)c->once->face_vertices[corner]);
}
static dvec3 limit_normal(const comparison *c, uint32_t corner) {
    const osd_values *n = &c->once->normals;
    return load(n->values + 3 * (size_t)(n->indices ? n->indices[corner] : c->once->face_vertices[corner]));
}

/* Points whose corners do not all have the normal of the first one. */
static bool measure_split(const comparison *c, double *split) {
    const kiln_cage *cage = c->cage;
    uint32_t *first = array_alloc(cage->vertex_count, sizeof *first); /* corner + 1 */
    uint32_t *face = array_alloc(cage->vertex_count, sizeof *face);
    uint8_t *differs = array_alloc(cage->vertex_count, 1);
    uint32_t count = 0;
    bool ok = first && face && differs;
    for (uint32_t f = 0, k = 0; ok && f < cage->face_count; f++)
        for (uint32_t end = k + cage->face_sizes[f]; k < end; k++) {
            uint32_t v = cage->face_vertices[k];
            if (!first[v]) first[v] = k + 1, face[v] = f;
            bool same = angle_between(authored_normal(c, f, k), authored_normal(c, face[v], first[v] - 1)) <= DEGREE;
            count += !same && !differs[v];
            differs[v] |= !same;
        }
    *split = cage->vertex_count ? (double)count / cage->vertex_count : 0;
    free(first);
    free(face);
    free(differs);
    return ok;
}

/* Per corner of the cage: the angle between its normals, the deviation at its vertex or the middle of its edge,
 * whichever is larger. */
typedef struct samples {
    float *angles, *deviations;
    uint32_t count;
    double slide, bulge;
} samples;

static double distance(dvec3 a, dvec3 b) { return d3_length(d3_sub(a, b)); }

/* Splits an offset into what changes the shape and what only slides along it: along the surface inside, along the
 * edge at a boundary, which is the outline. */
static double across(dvec3 offset, dvec3 edge, dvec3 normal, bool boundary, double *along) {
    dvec3 axis = d3_normalize(boundary ? edge : normal);
    double projected = d3_dot(offset, axis), rest = d3_length(d3_sub(offset, d3_scale(axis, projected)));
    *along = boundary ? fabs(projected) : rest;
    return boundary ? rest : fabs(projected);
}

static void sample_edge(const comparison *c, uint32_t face, uint32_t corner, uint32_t next, samples *s) {
    uint32_t here = c->once->cage_corners[corner], n = c->once->face_size;
    if (here == UINT32_MAX) return; /* in a hole */
    uint32_t between = here / n * n + (here + 1) % n; /* a child's next corner is the middle of its parent's edge */
    dvec3 a = authored_point(c, corner), b = authored_point(c, next), edge = d3_sub(b, a);
    dvec3 normal_a = authored_normal(c, face, corner), normal_b = authored_normal(c, face, next);
    dvec3 middle = d3_scale(d3_add(a, b), 0.5), normal = d3_add(normal_a, normal_b);
    dvec3 rise = d3_sub(d3_scale(normal_b, d3_dot(edge, normal_b)), d3_scale(normal_a, d3_dot(edge, normal_a)));
    dvec3 promised = d3_add(middle, d3_scale(rise, 0.125)), limit = limit_point(c, between);
    bool boundary = c->edges.edges[c->edges.corner_edges[corner]].uses == 1;
    double slide, ignored, at_vertex = distance(limit_point(c, here), a);
    double at_edge = across(d3_sub(limit, promised), edge, normal, boundary, &slide);
    s->angles[s->count] = (float)angle_between(normal_a, limit_normal(c, here));
    double deviation = at_vertex > at_edge ? at_vertex : at_edge;
    s->deviations[s->count++] = deviation < FLT_MAX ? (float)deviation : FLT_MAX; /* NaN too: it must not sort */
    s->slide = fmax(s->slide, slide);
    s->bulge = fmax(s->bulge, across(d3_sub(limit, middle), edge, normal, boundary, &ignored));
}

static int compare(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double quantile(float *values, uint32_t count, double share) {
    qsort(values, count, sizeof *values, compare);
    return count ? (double)values[(uint32_t)(share * (count - 1))] : 0;
}

bool smoothness_measure(const kiln_mesh *m, const kiln_cage *cage, const osd_surface *once, smoothness *result) {
    comparison c = {.mesh = m, .normals = mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0), .cage = cage, .once = once};
    samples s = {.angles = array_alloc(cage->corner_count, sizeof(float)),
                 .deviations = array_alloc(cage->corner_count, sizeof(float))};
    polygons p = {cage->vertex_count, cage->face_count, cage->corner_count, cage->face_sizes, cage->face_vertices};
    kiln_arena arena = {0};
    bool ok = s.angles && s.deviations && edges_build(&p, &arena, &c.edges) && measure_split(&c, &result->split);
    for (uint32_t f = 0, first = 0; ok && f < cage->face_count; first += cage->face_sizes[f++])
        for (uint32_t k = 0, size = cage->face_sizes[f]; k < size; k++)
            sample_edge(&c, f, first + k, first + (k + 1) % size, &s);
    if (ok) {
        double diagonal = distance(load(m->max), load(m->min)), scale = diagonal > 0 ? 1 / diagonal : 0;
        result->normal_rad = quantile(s.angles, s.count, 0.99);
        result->deviation = scale * quantile(s.deviations, s.count, 0.99);
        result->deviation_max = scale * quantile(s.deviations, s.count, 1);
        result->slide = scale * s.slide;
        result->bulge = scale * s.bulge;
    }
    arena_free(&arena);
    free(s.angles);
    free(s.deviations);
    return ok;
}

bool smoothness_decide(const smoothness *s, char reason[160]) {
    kiln_text text = {0};
    double degrees = s->normal_rad / DEGREE;
    bool smooth = false;
    if (s->split > SPLIT_MAX)
        text_format(&text, "flat or hard edges: normals are split at %.0f %% of the points", 100 * s->split);
    else if (s->bulge < BULGE_MIN)
        text_format(&text, "flat: there is nothing to round off");
    else if (s->bulge > BULGE_MAX)
        text_format(&text, "too coarse to tell: rounding it off would move it by %.1f %% of its size", 100 * s->bulge);
    else if (s->deviation > DEVIATION_MAX || s->deviation_max > DEVIATION_WORST)
        text_format(&text, "refining would deform it: by %.2f %% of its size at the worst place",
                    100 * s->deviation_max);
    else if (s->slide > SLIDE_MAX)
        text_format(&text, "refining would stretch its textures: by %.2f %% of its size at the worst place",
                    100 * s->slide);
    else if (s->normal_rad > NORMAL_MAX_RAD)
        text_format(&text, "not evidently smooth: authored normals are up to %.1f° off the limit's", degrees);
    else {
        text_format(&text, "smooth: authored normals agree with the limit within %.1f°, positions within %.3f %% of "
                           "its size", degrees, 100 * s->deviation_max);
        smooth = true;
    }
    snprintf(reason, 160, "%s", text.data ? text.data : "");
    text_free(&text);
    return smooth;
}
