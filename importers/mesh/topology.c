#include "importers/mesh/topology.h"

#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/hash.h"

#define EMPTY UINT32_MAX

/* A power of two, at most half full. */
static uint64_t table_size(uint32_t count) {
    uint64_t size = 16;
    while (size < 2 * (uint64_t)count) size *= 2;
    return size;
}

static uint32_t *table_create(uint64_t size) {
    uint32_t *table = array_alloc(size, sizeof *table);
    if (table) memset(table, 0xff, size * sizeof *table);
    return table;
}

/* Where a table starts differs from run to run: no file can be made whose keys all collide. Results do not depend on
 * it, since ids count in order of appearance. */
static uint32_t table_seed(const uint32_t *table) { return hash_u64((uint64_t)(uintptr_t)table); }

static uint32_t float_key(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits == 0x80000000u ? 0 : bits;
}

static uint32_t hash_corner(const corner_stream *streams, uint32_t stream_count, size_t corner, uint32_t seed) {
    uint32_t hash = seed;
    for (uint32_t s = 0; s < stream_count; s++)
        for (uint32_t k = 0; k < streams[s].width; k++)
            hash = hash_pair(hash, float_key(streams[s].values[corner * streams[s].width + k]));
    return hash;
}

static bool equal_corners(const corner_stream *streams, uint32_t stream_count, size_t a, size_t b) {
    for (uint32_t s = 0; s < stream_count; s++)
        for (uint32_t k = 0; k < streams[s].width; k++)
            if (float_key(streams[s].values[a * streams[s].width + k]) !=
                float_key(streams[s].values[b * streams[s].width + k]))
                return false;
    return true;
}

bool topology_weld(const corner_stream *streams, uint32_t stream_count, uint32_t corner_count, uint32_t *ids,
                   uint32_t *id_count) {
    uint64_t size = table_size(corner_count);
    uint32_t *table = table_create(size); /* the first corner with each key */
    if (!table) return false;
    uint32_t seed = table_seed(table), count = 0;
    for (uint32_t corner = 0; corner < corner_count; corner++) {
        uint64_t slot = hash_corner(streams, stream_count, corner, seed) & (size - 1);
        while (table[slot] != EMPTY && !equal_corners(streams, stream_count, table[slot], corner))
            slot = (slot + 1) & (size - 1);
        if (table[slot] == EMPTY) {
            table[slot] = corner;
            ids[corner] = count++;
        } else {
            ids[corner] = ids[table[slot]];
        }
    }
    free(table);
    *id_count = count;
    return true;
}

/* Half-edges of one undirected edge that wait for a twin: a queue, linked through `following`. They all run the same
 * way, since one that runs the other way is paired at once. */
typedef struct waiting {
    uint32_t *table; /* a half-edge that names the edge of this slot */
    uint32_t *first, *last;
    uint32_t *following;
    uint64_t size;
    uint32_t seed;
} waiting;

static bool waiting_create(waiting *w, uint32_t corner_count) {
    w->size = table_size(corner_count);
    w->table = table_create(w->size);
    w->first = table_create(corner_count);
    w->last = table_create(corner_count);
    w->following = table_create(corner_count);
    w->seed = w->table ? table_seed(w->table) : 0;
    return w->table && w->first && w->last && w->following;
}

static void waiting_free(waiting *w) {
    free(w->table);
    free(w->first);
    free(w->last);
    free(w->following);
}

/* The half-edge under which the queue of this edge is kept. */
static uint32_t find_queue(waiting *w, const uint32_t *ids, uint32_t edge) {
    uint32_t from = ids[edge], to = ids[corner_next(edge)];
    uint32_t low = from < to ? from : to, high = from < to ? to : from;
    uint64_t slot = hash_triple(low, high, w->seed) & (w->size - 1);
    for (; w->table[slot] != EMPTY; slot = (slot + 1) & (w->size - 1)) {
        uint32_t f = ids[w->table[slot]], t = ids[corner_next(w->table[slot])];
        if ((f == low && t == high) || (f == high && t == low)) return w->table[slot];
    }
    return w->table[slot] = edge;
}

static void pair_edge(waiting *w, const uint32_t *ids, uint32_t edge, uint32_t *twins) {
    uint32_t queue = find_queue(w, ids, edge), head = w->first[queue];
    if (head != EMPTY && ids[head] == ids[corner_next(edge)]) {
        w->first[queue] = w->following[head];
        twins[head] = edge;
        twins[edge] = head;
        return;
    }
    if (head == EMPTY) w->first[queue] = edge;
    else w->following[w->last[queue]] = edge;
    w->last[queue] = edge;
}

bool topology_twins(const uint32_t *ids, uint32_t triangle_count, const uint8_t *skip, uint32_t *twins) {
    uint32_t corner_count = 3 * triangle_count;
    waiting w;
    bool ready = waiting_create(&w, corner_count);
    for (uint32_t corner = 0; ready && corner < corner_count; corner++) {
        twins[corner] = TOPOLOGY_NO_TWIN;
        if (!skip[corner / 3]) pair_edge(&w, ids, corner, twins);
    }
    waiting_free(&w);
    return ready;
}

uint32_t *topology_groups_create(uint32_t corner_count) {
    uint32_t *groups = array_alloc(corner_count, sizeof *groups);
    for (uint32_t i = 0; groups && i < corner_count; i++) groups[i] = i;
    return groups;
}

static uint32_t find_root(uint32_t *groups, uint32_t corner) {
    while (groups[corner] != corner) {
        groups[corner] = groups[groups[corner]];
        corner = groups[corner];
    }
    return corner;
}

void topology_groups_join(uint32_t *groups, uint32_t a, uint32_t b) {
    a = find_root(groups, a);
    b = find_root(groups, b);
    if (a < b) groups[b] = a;
    else groups[a] = b;
}

uint32_t topology_groups_number(uint32_t *groups, uint32_t corner_count) {
    uint32_t count = 0;
    /* A parent is never behind its child: going forwards, parents are roots, then numbers, before they are read. */
    for (uint32_t i = 0; i < corner_count; i++) groups[i] = groups[groups[i]];
    for (uint32_t i = 0; i < corner_count; i++) groups[i] = groups[i] == i ? count++ : groups[groups[i]];
    return count;
}

dvec3 corner_perpendicular(dvec3 n) {
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    dvec3 axis = x <= y && x <= z ? (dvec3){1, 0, 0} : y <= z ? (dvec3){0, 1, 0} : (dvec3){0, 0, 1};
    dvec3 across = d3_normalize(d3_sub(axis, d3_scale(n, d3_dot(n, axis))));
    return d3_dot(across, across) > 0.5 ? across : (dvec3){1, 0, 0};
}
