/* render/world/closed.c: is a mesh that bounds a volume closed? Vertices of equal position are one; then every edge of a
 * closed mesh is gone along as often one way as the other. A face that is turned over breaks that as a hole does. */
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "render/world/media.h"

/* Open addressing: vertices by position, and edges by their ends. */
typedef struct welder {
    const kiln_mesh *mesh;
    uint32_t *vertices, *welded; /* slots, 1 + vertex; and of each vertex the first at its place */
    uint32_t (*edges)[2];        /* slots, 1 + the smaller end, and the larger */
    int32_t *turns;              /* of each edge: one way less the other */
    size_t vertex_slots, edge_slots;
} welder;

static size_t slots_for(size_t count) {
    size_t slots = 16;
    while (slots < 2 * count) slots *= 2;
    return slots;
}

static void weld(welder *w, uint32_t vertex) {
    float p[3];
    for (int k = 0; k < 3; k++) p[k] = w->mesh->positions[3 * (size_t)vertex + (size_t)k] + 0.0f; /* −0 is 0 */
    uint32_t bits[3];
    memcpy(bits, p, sizeof bits);
    size_t slot = hash_triple(bits[0], bits[1], bits[2]) & (w->vertex_slots - 1);
    for (; w->vertices[slot]; slot = (slot + 1) & (w->vertex_slots - 1)) {
        const float *q = w->mesh->positions + 3 * (size_t)(w->vertices[slot] - 1);
        if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) break;
    }
    if (!w->vertices[slot]) w->vertices[slot] = vertex + 1;
    w->welded[vertex] = w->vertices[slot] - 1;
}

static void turn(welder *w, uint32_t from, uint32_t to) {
    uint32_t low = from < to ? from : to, high = from < to ? to : from;
    size_t slot = hash_pair(low, high) & (w->edge_slots - 1);
    if (low == high) return; /* a side without length */
    while (w->edges[slot][0] && (w->edges[slot][0] != low + 1 || w->edges[slot][1] != high))
        slot = (slot + 1) & (w->edge_slots - 1);
    w->edges[slot][0] = low + 1, w->edges[slot][1] = high;
    w->turns[slot] += from < to ? 1 : -1;
}

/* Sides of the faces of a material that have no counterpart. */
static size_t open_edges(welder *w, kiln_id material) {
    const kiln_mesh *m = w->mesh;
    size_t open = 0;
    for (uint32_t v = 0; v < m->vertex_count; v++) weld(w, v);
    for (uint32_t f = 0; f < m->face_count; f++) {
        const uint32_t *corners = m->face_vertices + mesh_face_first(m, f);
        uint32_t n = mesh_face_size(m, f);
        for (uint32_t c = 0; mesh_face_material(m, f) == material && c < n; c++)
            turn(w, w->welded[corners[c]], w->welded[corners[(c + 1) % n]]);
    }
    for (size_t i = 0; i < w->edge_slots; i++) open += (size_t)abs(w->turns[i]);
    return open;
}

bool mesh_is_open(const kiln_mesh *m, kiln_id material, size_t *edges) {
    welder w = {.mesh = m, .vertex_slots = slots_for(m->vertex_count), .edge_slots = slots_for(m->corner_count)};
    w.vertices = array_alloc(w.vertex_slots, sizeof *w.vertices);
    w.welded = array_alloc(m->vertex_count, sizeof *w.welded);
    w.edges = array_alloc(w.edge_slots, sizeof *w.edges);
    w.turns = array_alloc(w.edge_slots, sizeof *w.turns);
    bool room = w.vertices && w.welded && w.edges && w.turns; /* without, nobody is warned, and the render fails */
    *edges = room ? open_edges(&w, material) : 0;
    free(w.vertices);
    free(w.welded);
    free(w.edges);
    free(w.turns);
    return *edges > 0;
}
