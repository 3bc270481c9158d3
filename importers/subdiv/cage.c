#include "importers/subdiv/cage.h"

#include <stdio.h>
#include <stdlib.h>

#include "importers/subdiv/faces.h"
#include "importers/subdiv/tags.h"

/* At least this share of the triangles pairs up in meshes that were quads, at most 25 % in those that were not. */
static const double QUAD_RATE = 0.7;

typedef struct builder {
    const kiln_mesh *mesh;
    const cage_options *options;
    kiln_arena *arena;     /* of the cage */
    kiln_arena temporary;  /* of the way to it */
    kiln_cage *cage;
    char *obstacle;
    const kiln_where *where;
    kiln_report *report;
    vertex_weld weld;
    face_list faces;
    bool rebuilt; /* the mesh was cut up and is put together */
} builder;

#define OBSTACLE(b, ...) (snprintf((b)->obstacle, 160, __VA_ARGS__), false)

static bool no_memory(builder *b) { return report_no_memory(b->report, "building a subdivision cage"); }

static kiln_scheme wanted_scheme(const builder *b) {
    kiln_scheme asked = b->options->scheme;
    if (asked != KILN_SCHEME_NONE && asked != KILN_SCHEME_AUTO) return asked;
    asked = b->mesh->subdivision.scheme;
    return asked == KILN_SCHEME_NONE ? KILN_SCHEME_AUTO : asked;
}

/* Joins what was cut and settles the scheme. */
static bool rebuild_faces(builder *b) {
    kiln_subdivision *rules = &b->cage->rules;
    const kiln_mesh *m = b->mesh;
    if (rules->fan_encoded && !m->face_offsets) {
        b->cage->quad_rate = 1;
        return faces_join_fans(m, &b->weld, &b->temporary, &b->faces) || no_memory(b);
    }
    if (m->face_offsets) return faces_take(m, &b->weld, true, &b->temporary, &b->faces) || no_memory(b);
    face_list triangles;
    edge_table edges;
    if (!faces_take(m, &b->weld, true, &b->temporary, &triangles)) return no_memory(b);
    polygons p = faces_polygons(&triangles, &b->weld);
    if (!edges_build(&p, &b->temporary, &edges)) return no_memory(b);
    uint32_t lost;
    const float *sharpness = tags_edge_sharpness(m, &b->weld, &edges, &b->temporary, &lost);
    uint8_t *keep = ARENA_ARRAY(&b->temporary, uint8_t, edges.count);
    for (uint32_t e = 0; sharpness && keep && e < edges.count; e++) keep[e] = sharpness[e] > 0;
    face_list quads;
    if (!sharpness || !keep ||
        !faces_pair(m, &b->weld, &triangles, &edges, keep, &b->temporary, &quads, &b->cage->quad_rate))
        return no_memory(b);
    if (rules->scheme == KILN_SCHEME_AUTO && b->cage->quad_rate < QUAD_RATE) rules->scheme = KILN_SCHEME_LOOP;
    b->faces = rules->scheme == KILN_SCHEME_LOOP ? triangles : quads;
    return true;
}

static bool take_faces(builder *b) {
    const kiln_mesh *m = b->mesh;
    kiln_subdivision *rules = &b->cage->rules;
    *rules = m->subdivision;
    rules->scheme = wanted_scheme(b);
    b->cage->quad_rate = 1;
    bool triangles_alone = m->subdivision.scheme == KILN_SCHEME_NONE && !m->face_offsets;
    b->rebuilt = rules->triangulated || rules->fan_encoded || triangles_alone ||
                 m->subdivision.scheme == KILN_SCHEME_AUTO;
    if (!weld_vertices(m, b->rebuilt, &b->temporary, &b->weld)) return no_memory(b);
    if (rules->scheme == KILN_SCHEME_LOOP && m->face_offsets) {
        if (!faces_triangulate(m, &b->weld, &b->temporary, &b->faces)) return no_memory(b);
    } else if (b->rebuilt) {
        if (!rebuild_faces(b)) return false;
        rules->smooth_triangles = true; /* better than Catmull's weights wherever triangles are left among the quads */
    } else if (!faces_take(m, &b->weld, false, &b->temporary, &b->faces)) {
        return no_memory(b);
    }
    if (rules->scheme == KILN_SCHEME_AUTO) rules->scheme = KILN_SCHEME_CATMULL_CLARK;
    /* Nobody said how to round the UVs of a mesh that was never meant as a cage: its textures stay where they are. */
    bool silent = m->subdivision.scheme == KILN_SCHEME_AUTO || m->subdivision.scheme == KILN_SCHEME_NONE;
    if (silent) rules->fvar_boundary = KILN_FVAR_ALL;
    return true;
}

/* What Far crashes on, or takes for ever over. */
static bool check_limits(builder *b) {
    const face_list *f = &b->faces;
    if (!f->face_count) return OBSTACLE(b, "it has no faces");
    if (f->corner_count > INT32_MAX / 4 || b->weld.count > INT32_MAX / 4)
        return OBSTACLE(b, "it has %u corners (at most %d)", f->corner_count, INT32_MAX / 4);
    uint32_t *valences = ARENA_ARRAY(&b->temporary, uint32_t, b->weld.count);
    if (!valences) return no_memory(b);
    for (uint32_t i = 0, c = 0; i < f->face_count; i++) {
        if (f->sizes[i] > CAGE_VALENCE_MAX)
            return OBSTACLE(b, "face %u has %u corners (at most %d)", f->sources[i], f->sizes[i], CAGE_VALENCE_MAX);
        for (uint32_t end = c + f->sizes[i]; c < end; c++)
            if (++valences[f->points[c]] > CAGE_VALENCE_MAX)
                return OBSTACLE(b, "vertex %u belongs to more than %d faces", b->weld.sources[f->points[c]],
                                CAGE_VALENCE_MAX);
    }
    return true;
}

static bool copy_cage(builder *b) {
    kiln_cage *c = b->cage;
    const face_list *f = &b->faces;
    const kiln_mesh *m = b->mesh;
    c->vertex_count = b->weld.count;
    c->face_count = f->face_count;
    c->corner_count = f->corner_count;
    c->time_count = m->time_count;
    c->face_sizes = arena_copy(b->arena, f->sizes, f->face_count, sizeof *f->sizes);
    c->face_vertices = arena_copy(b->arena, f->points, f->corner_count, sizeof *f->points);
    c->face_sources = arena_copy(b->arena, f->sources, f->face_count, sizeof *f->sources);
    c->corner_sources = arena_copy(b->arena, f->corners, f->corner_count, sizeof *f->corners);
    c->vertex_sources = arena_copy(b->arena, b->weld.sources, b->weld.count, sizeof *b->weld.sources);
    float *positions = arena_array(b->arena, (size_t)c->time_count * c->vertex_count, 3 * sizeof *positions);
    if (!c->face_sizes || !c->face_vertices || !c->face_sources || !c->corner_sources || !c->vertex_sources ||
        !positions)
        return no_memory(b);
    c->positions = positions;
    for (uint32_t t = 0; t < c->time_count; t++)
        for (uint32_t v = 0; v < c->vertex_count; v++, positions += 3) {
            const float *x = m->positions + 3 * ((size_t)m->vertex_count * t + c->vertex_sources[v]);
            for (int k = 0; k < 3; k++) positions[k] = x[k];
        }
    return true;
}

static bool tag_cage(builder *b) {
    polygons p = faces_polygons(&b->faces, &b->weld);
    edge_table edges;
    uint32_t lost = 0;
    if (!edges_build(&p, &b->temporary, &edges)) return no_memory(b);
    float *sharpness = tags_edge_sharpness(b->mesh, &b->weld, &edges, &b->temporary, &lost);
    bool ok = sharpness && (!(b->options->crease_angle_rad > 0) ||
                            tags_crease_angle(b->cage, &edges, b->options->crease_angle_rad, sharpness, &b->temporary));
    if (!ok || !tags_apply(b->mesh, &b->weld, &edges, sharpness, b->arena, b->cage)) return no_memory(b);
    if (lost)
        report_warning(b->report, KILN_CODE_GEOMETRY, b->where, NULL, "%u creases follow no edge of the mesh: left out",
                       lost);
    return channels_collect(b->mesh, b->rebuilt, b->arena, b->cage) || no_memory(b);
}

bool cage_build(const kiln_mesh *mesh, const cage_options *options, kiln_arena *arena, kiln_cage *cage,
                char obstacle[160], const kiln_where *where, kiln_report *report) {
    builder b = {.mesh = mesh, .options = options, .arena = arena, .cage = cage, .obstacle = obstacle,
                 .where = where, .report = report};
    *cage = (kiln_cage){0};
    obstacle[0] = '\0';
    bool ok = take_faces(&b) && check_limits(&b) && copy_cage(&b) && tag_cage(&b);
    arena_free(&b.temporary);
    return ok;
}

uint64_t cage_refined_faces(const kiln_cage *c, uint32_t level) {
    bool loop = c->rules.scheme == KILN_SCHEME_LOOP;
    uint64_t faces = loop || !level ? c->face_count : c->corner_count; /* Catmull-Clark: a quad for each corner */
    uint32_t doublings = 2 * (loop || !level ? level : level - 1);
    return doublings > 30 ? UINT64_MAX / 4 : faces << doublings;
}

uint64_t cage_refined_triangles(const kiln_cage *c, uint32_t level) {
    return cage_refined_faces(c, level) * (c->rules.scheme == KILN_SCHEME_LOOP ? 1 : 2);
}
