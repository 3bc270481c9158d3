#include <stdlib.h>
#include <string.h>

#include "importers/mesh/topology.h"
#include "importers/subdiv/tags.h"

/* The keys of corners: point, and either the mesh's own value index or the value itself. */
static bool number_corners(const kiln_cage *c, const kiln_primvar *p, const float *values, bool by_index,
                           uint32_t *indices, uint32_t *count) {
    float *points = array_alloc(c->corner_count, sizeof *points), *own = array_alloc(c->corner_count, sizeof *own);
    bool ok = points && own;
    if (ok) {
        /* Integers keep their bits: topology_weld compares bits, and no number of vertices reaches the bits of −0. */
        memcpy(points, c->face_vertices, c->corner_count * sizeof *points);
        for (uint32_t k = 0; by_index && k < c->corner_count; k++)
            memcpy(&own[k], &p->indices[c->corner_sources[k]], sizeof *own);
        corner_stream streams[2] = {{points, 1}, {by_index ? own : values, by_index ? 1 : primvar_width(p->kind)}};
        ok = topology_weld(streams, 2, c->corner_count, indices, count);
    }
    free(points);
    free(own);
    return ok;
}

/* values[corner] for every corner of the cage. */
static void gather(const kiln_mesh *m, const kiln_cage *c, const kiln_primvar *p, float *values) {
    uint32_t width = primvar_width(p->kind);
    for (uint32_t f = 0, k = 0; f < c->face_count; f++)
        for (uint32_t end = k + c->face_sizes[f]; k < end; k++) {
            uint32_t corner = c->corner_sources[k];
            memcpy(values + (size_t)width * k, primvar_at(p, c->face_sources[f], corner, m->face_vertices[corner]),
                   width * sizeof *values);
        }
}

static bool collect_corners(const kiln_mesh *m, const kiln_cage *c, const kiln_primvar *p, kiln_arena *arena,
                            cage_channel *out) {
    uint32_t width = primvar_width(p->kind);
    uint32_t *indices = ARENA_ARRAY(arena, uint32_t, c->corner_count);
    float *all = array_alloc(c->corner_count, width * sizeof *all), *kept = NULL;
    bool by_index = p->indices && p->interpolation == KILN_FACE_VARYING;
    bool ok = indices && all;
    if (ok) gather(m, c, p, all);
    ok = ok && number_corners(c, p, all, by_index, indices, &out->value_count);
    kept = ok ? arena_array(arena, out->value_count, width * sizeof *kept) : NULL;
    for (uint32_t k = 0; kept && k < c->corner_count; k++)
        memcpy(kept + (size_t)width * indices[k], all + (size_t)width * k, width * sizeof *kept);
    free(all);
    out->values = kept;
    out->indices = indices;
    return kept != NULL;
}

static bool collect_vertices(const kiln_cage *c, const kiln_primvar *p, kiln_arena *arena, cage_channel *out) {
    uint32_t width = primvar_width(p->kind);
    float *values = arena_array(arena, c->vertex_count, width * sizeof *values);
    for (uint32_t v = 0; values && v < c->vertex_count; v++)
        memcpy(values + (size_t)width * v, primvar_at(p, 0, 0, c->vertex_sources[v]), width * sizeof *values);
    out->values = values;
    out->value_count = c->vertex_count;
    return values != NULL;
}

bool channels_collect(const kiln_mesh *m, bool welded, kiln_arena *arena, kiln_cage *c) {
    c->channels = ARENA_ARRAY(arena, cage_channel, m->primvar_count);
    if (!c->channels) return false;
    for (uint32_t i = 0; i < m->primvar_count; i++) {
        const kiln_primvar *p = &m->primvars[i];
        bool refined = p->kind == KILN_PRIMVAR_UV || p->kind == KILN_PRIMVAR_COLOR ||
                       (p->kind == KILN_PRIMVAR_NORMAL && c->rules.scheme == KILN_SCHEME_BILINEAR);
        if (!refined || p->interpolation == KILN_UNIFORM || p->interpolation == KILN_CONSTANT) continue;
        cage_channel *out = &c->channels[c->channel_count++];
        *out = (cage_channel){.kind = p->kind, .set = p->set, .width = primvar_width(p->kind)};
        bool ok = p->interpolation == KILN_VERTEX && !welded ? collect_vertices(c, p, arena, out)
                                                             : collect_corners(m, c, p, arena, out);
        if (!ok) return false;
    }
    return true;
}
