#include <stdlib.h>
#include <string.h>

#include "importers/mesh/topology.h"
#include "importers/subdiv/faces.h"

/* ids[v]: the same number for vertices that are one point. */
static bool identify(const kiln_mesh *m, bool by_position, uint32_t *ids) {
    if (!by_position) {
        for (uint32_t v = 0; v < m->vertex_count; v++) ids[v] = v;
        return true;
    }
    corner_stream *times = array_alloc(m->time_count, sizeof *times);
    uint32_t count;
    for (uint32_t t = 0; times && t < m->time_count; t++)
        times[t] = (corner_stream){m->positions + 3 * (size_t)m->vertex_count * t, 3};
    bool ok = times && topology_weld(times, m->time_count, m->vertex_count, ids, &count);
    free(times);
    return ok;
}

bool weld_vertices(const kiln_mesh *m, bool by_position, kiln_arena *arena, vertex_weld *w) {
    w->map = ARENA_ARRAY(arena, uint32_t, m->vertex_count);
    w->sources = ARENA_ARRAY(arena, uint32_t, m->vertex_count);
    w->count = 0;
    uint32_t *ids = array_alloc(m->vertex_count, sizeof *ids);
    uint32_t *points = array_alloc(m->vertex_count, sizeof *points); /* id → point */
    bool ok = w->map && w->sources && ids && points && identify(m, by_position, ids);
    if (ok) {
        memset(w->map, 0xff, m->vertex_count * sizeof *w->map);
        memset(points, 0xff, m->vertex_count * sizeof *points);
        for (uint32_t c = 0; c < m->corner_count; c++) {
            uint32_t v = m->face_vertices[c], id = ids[v];
            if (points[id] == EDGE_NONE) {
                w->sources[w->count] = v;
                points[id] = w->count++;
            }
            w->map[v] = points[id];
        }
    }
    free(ids);
    free(points);
    return ok;
}
