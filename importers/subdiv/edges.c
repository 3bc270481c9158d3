#include "importers/subdiv/edges.h"

#include <stdlib.h>

static uint32_t size_of(const polygons *p, uint32_t face) { return p->face_sizes ? p->face_sizes[face] : 3; }

/* A half-edge for sorting: the upper vertex above, the corner below. */
static int compare(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Half-edges in buckets by their lower vertex: bucket v is slots[start[v]] … slots[start[v + 1] − 1]. */
static void fill_buckets(const polygons *p, uint32_t *start, uint64_t *slots) {
    const uint32_t *v = p->face_vertices;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t f = 0, c = 0; f < p->face_count; f++) {
            uint32_t first = c, end = c + size_of(p, f);
            for (; c < end; c++) {
                uint32_t a = v[c], b = v[c + 1 < end ? c + 1 : first], low = a < b ? a : b, high = a < b ? b : a;
                if (pass == 0) start[low + 1]++;
                else slots[start[low]++] = (uint64_t)high << 32 | c;
            }
        }
        if (pass == 0)
            for (uint32_t i = 0; i < p->vertex_count; i++) start[i + 1] += start[i];
    }
    for (uint32_t i = p->vertex_count; i > 0; i--) start[i] = start[i - 1]; /* filling has moved them on */
    start[0] = 0;
}

/* Equal half-edges of a sorted bucket become one edge. */
static uint32_t gather(const uint64_t *bucket, uint32_t count, uint32_t low, polygon_edge *edges, uint32_t edge_count,
                       uint32_t *corner_edges) {
    for (uint32_t i = 0; i < count; i++) {
        uint32_t high = (uint32_t)(bucket[i] >> 32), corner = (uint32_t)bucket[i];
        bool again = i && (uint32_t)(bucket[i - 1] >> 32) == high;
        polygon_edge *e = &edges[again ? edge_count - 1 : edge_count++];
        if (!again) *e = (polygon_edge){{low, high}, 0, {corner, EDGE_NONE}};
        if (e->uses++ == 1) e->corners[1] = corner;
        corner_edges[corner] = edge_count - 1;
    }
    return edge_count;
}

bool edges_build(const polygons *p, kiln_arena *arena, edge_table *table) {
    *table = (edge_table){0};
    polygon_edge *edges = ARENA_ARRAY(arena, polygon_edge, p->corner_count);
    uint32_t *corner_edges = ARENA_ARRAY(arena, uint32_t, p->corner_count);
    uint32_t *first = ARENA_ARRAY(arena, uint32_t, (size_t)p->vertex_count + 1);
    uint32_t *start = array_alloc((size_t)p->vertex_count + 1, sizeof *start);
    uint64_t *slots = array_alloc(p->corner_count, sizeof *slots);
    bool ok = edges && corner_edges && first && start && slots;
    if (ok) {
        fill_buckets(p, start, slots);
        for (uint32_t v = 0; v < p->vertex_count; v++) {
            uint32_t count = start[v + 1] - start[v];
            qsort(slots + start[v], count, sizeof *slots, compare);
            first[v] = table->count;
            table->count = gather(slots + start[v], count, v, edges, table->count, corner_edges);
        }
        first[p->vertex_count] = table->count;
        table->edges = edges;
        table->corner_edges = corner_edges;
        table->first = first;
    }
    free(start);
    free(slots);
    return ok;
}

uint32_t edges_find(const edge_table *table, uint32_t a, uint32_t b) {
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    uint32_t begin = table->first[low], end = table->first[low + 1];
    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;
        if (table->edges[middle].vertices[1] < high) begin = middle + 1;
        else end = middle;
    }
    bool found = begin < table->first[low + 1] && table->edges[begin].vertices[1] == high;
    return found ? begin : EDGE_NONE;
}
