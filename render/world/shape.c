#include "render/world/shape.h"

#include <stdlib.h>

#include "base/hash.h"
#include "scene/triangulate.h"

shape_primvars shape_read_primvars(const shape *s, const world *w) {
    shape_primvars p = {0};
    if (HOLDS(w, SMOOTH_NORMALS)) p.normal = mesh_primvar(s->mesh, KILN_PRIMVAR_NORMAL, 0);
    if (HOLDS(w, VERTEX_COLORS)) p.color = mesh_primvar(s->mesh, KILN_PRIMVAR_COLOR, 0);
    if (world_wants_tangents(w)) p.tangent = mesh_primvar(s->mesh, KILN_PRIMVAR_TANGENT, 0);
    for (uint32_t k = 0; k < w->uv_set_count; k++) p.uv[k] = mesh_primvar(s->mesh, KILN_PRIMVAR_UV, w->uv_sets[k]);
    return p;
}

enum { KEYS = 4 + WORLD_UV_SETS };

/* Value numbers of a corner: equal keys are one vertex. */
static void corner_key(const shape_primvars *p, uint32_t face, uint32_t corner, uint32_t vertex, uint32_t key[KEYS]) {
    const kiln_primvar *list[KEYS - 1] = {p->normal, p->tangent, p->color};
    for (int k = 0; k < WORLD_UV_SETS; k++) list[3 + k] = p->uv[k];
    key[0] = vertex;
    for (int k = 0; k < KEYS - 1; k++) key[k + 1] = list[k] ? primvar_index(list[k], face, corner, vertex) : 0;
}

static bool is_per_vertex(const kiln_primvar *p) { return !p || p->interpolation == KILN_VERTEX || p->interpolation == KILN_CONSTANT; }
static bool all_per_vertex(const shape_primvars *p) {
    bool all = is_per_vertex(p->normal) && is_per_vertex(p->tangent) && is_per_vertex(p->color);
    for (int k = 0; k < WORLD_UV_SETS; k++) all = all && is_per_vertex(p->uv[k]);
    return all;
}

/* Open addressing over the unified vertices; keys lie beside them. */
static bool unify(shape *s, const shape_primvars *p) {
    size_t corners = 3 * (size_t)s->triangle_count, slots = 16;
    while (slots < 2 * corners) slots *= 2;
    uint32_t *table = array_alloc(slots, sizeof *table); /* 1 + vertex */
    uint32_t(*keys)[KEYS] = array_alloc(corners, sizeof *keys);
    s->vertices = array_alloc(corners, sizeof *s->vertices);
    s->source = array_alloc(2 * corners, sizeof *s->source);
    bool done = table && keys && s->vertices && s->source;
    for (size_t i = 0; done && i < corners; i++) {
        uint32_t triangle = (uint32_t)(i / 3), face = shape_face(s, triangle);
        uint32_t corner = shape_corner(s, triangle, (uint32_t)(i % 3)), key[KEYS], hash = 0;
        corner_key(p, face, corner, s->mesh->face_vertices[corner], key);
        for (int k = 0; k < KEYS; k++) hash = hash_pair(hash, key[k]);
        size_t slot = hash & (slots - 1);
        while (table[slot] && memcmp(keys[table[slot] - 1], key, sizeof key) != 0) slot = (slot + 1) & (slots - 1);
        if (!table[slot]) {
            memcpy(keys[s->vertex_count], key, sizeof key);
            s->source[2 * (size_t)s->vertex_count] = face;
            s->source[2 * (size_t)s->vertex_count + 1] = corner;
            table[slot] = ++s->vertex_count;
        }
        s->vertices[i] = table[slot] - 1;
    }
    free(table);
    free(keys);
    return done;
}

bool shape_make(shape *s, const world *w) {
    const kiln_mesh *mesh = s->mesh;
    s->triangle_count = mesh->triangle_count;
    if (mesh->face_offsets) {
        s->corners = array_alloc(3 * (size_t)s->triangle_count, sizeof *s->corners);
        s->faces = array_alloc(s->triangle_count, sizeof *s->faces);
        if (!s->corners || !s->faces || !mesh_triangulate(mesh, s->corners, s->faces)) return false;
    }
    shape_primvars primvars = shape_read_primvars(s, w);
    if (all_per_vertex(&primvars)) s->vertex_count = mesh->vertex_count;
    else if (!unify(s, &primvars)) return false;
    for (uint32_t t = 0; t < s->triangle_count; t++) s->coverage_count += shape_has_coverage(w, s, t);
    return true;
}

void shape_free(shape *s) {
    free(s->corners);
    free(s->faces);
    free(s->vertices);
    free(s->source);
}
