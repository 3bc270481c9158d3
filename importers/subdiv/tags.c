#include "importers/subdiv/tags.h"

#include <math.h>

#include "importers/mesh/normals.h"

/* Sdc::Crease::SHARPNESS_INFINITE. */
static const float SHARPNESS_INFINITE = 10;

float *tags_edge_sharpness(const kiln_mesh *m, const vertex_weld *w, const edge_table *edges, kiln_arena *arena,
                           uint32_t *lost) {
    float *sharpness = ARENA_ARRAY(arena, float, edges->count);
    const kiln_subdivision *s = &m->subdivision;
    *lost = 0;
    for (uint32_t i = 0; sharpness && i < s->crease_count; i++) {
        uint32_t a = w->map[s->crease_vertices[2 * i]], b = w->map[s->crease_vertices[2 * i + 1]];
        uint32_t e = a == EDGE_NONE || b == EDGE_NONE ? EDGE_NONE : edges_find(edges, a, b);
        if (e == EDGE_NONE) ++*lost;
        else sharpness[e] = fmaxf(sharpness[e], s->crease_sharpness[i]);
    }
    return sharpness;
}

bool tags_crease_angle(const kiln_cage *c, const edge_table *edges, double crease_angle_rad, float *edge_sharpness,
                       kiln_arena *temporary) {
    float(*normals)[3] = arena_array(temporary, c->face_count, sizeof *normals);
    uint32_t *corner_faces = ARENA_ARRAY(temporary, uint32_t, c->corner_count);
    if (!normals || !corner_faces) return false;
    for (uint32_t f = 0, first = 0; f < c->face_count; first += c->face_sizes[f++]) {
        normals_face(c->positions, c->face_vertices + first, c->face_sizes[f], normals[f]);
        for (uint32_t k = 0; k < c->face_sizes[f]; k++) corner_faces[first + k] = f;
    }
    double cosine = cos(crease_angle_rad);
    for (uint32_t e = 0; e < edges->count; e++) {
        const polygon_edge *edge = &edges->edges[e];
        if (!edge_is_regular(edge, c->face_vertices)) continue; /* boundaries and worse are sharp already */
        const float *a = normals[corner_faces[edge->corners[0]]], *b = normals[corner_faces[edge->corners[1]]];
        double bend = (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
        if (bend < cosine) edge_sharpness[e] = SHARPNESS_INFINITE;
    }
    return true;
}

static bool apply_creases(const edge_table *edges, const float *edge_sharpness, kiln_arena *arena,
                          kiln_subdivision *rules) {
    uint32_t count = 0;
    for (uint32_t e = 0; e < edges->count; e++) count += edge_sharpness[e] > 0;
    uint32_t *vertices = ARENA_ARRAY(arena, uint32_t, 2 * (size_t)count);
    float *sharpness = ARENA_ARRAY(arena, float, count);
    if (!vertices || !sharpness) return false;
    rules->crease_vertices = vertices;
    rules->crease_sharpness = sharpness;
    rules->crease_count = count;
    for (uint32_t e = 0; e < edges->count; e++) {
        if (!(edge_sharpness[e] > 0)) continue;
        *vertices++ = edges->edges[e].vertices[0];
        *vertices++ = edges->edges[e].vertices[1];
        *sharpness++ = edge_sharpness[e];
    }
    return true;
}

static bool apply_corners(const kiln_mesh *m, const vertex_weld *w, kiln_arena *arena, kiln_subdivision *rules) {
    const kiln_subdivision *s = &m->subdivision;
    uint32_t *vertices = ARENA_ARRAY(arena, uint32_t, s->corner_count);
    float *sharpness = ARENA_ARRAY(arena, float, s->corner_count);
    if (!vertices || !sharpness) return false;
    rules->corner_count = 0;
    for (uint32_t i = 0; i < s->corner_count; i++) {
        uint32_t point = w->map[s->corner_vertices[i]];
        if (point == EDGE_NONE) continue; /* no face reaches it */
        vertices[rules->corner_count] = point;
        sharpness[rules->corner_count++] = s->corner_sharpness[i];
    }
    rules->corner_vertices = vertices;
    rules->corner_sharpness = sharpness;
    return true;
}

static bool apply_holes(const kiln_mesh *m, kiln_arena *arena, kiln_cage *c) {
    bool *is_hole = arena_array(arena, m->face_count, sizeof *is_hole);
    uint32_t *holes = ARENA_ARRAY(arena, uint32_t, m->subdivision.hole_count ? c->face_count : 0);
    if (!is_hole || !holes) return false;
    for (uint32_t i = 0; i < m->subdivision.hole_count; i++) is_hole[m->subdivision.holes[i]] = true;
    c->rules.holes = holes;
    c->rules.hole_count = 0;
    for (uint32_t f = 0; m->subdivision.hole_count && f < c->face_count; f++)
        if (is_hole[c->face_sources[f]]) holes[c->rules.hole_count++] = f;
    return true;
}

bool tags_apply(const kiln_mesh *m, const vertex_weld *w, const edge_table *edges, const float *edge_sharpness,
                kiln_arena *arena, kiln_cage *c) {
    return apply_creases(edges, edge_sharpness, arena, &c->rules) && apply_corners(m, w, arena, &c->rules) &&
           apply_holes(m, arena, c);
}
