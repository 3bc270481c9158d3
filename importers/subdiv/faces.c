#include "importers/subdiv/faces.h"

#include "scene/triangulate.h"

polygons faces_polygons(const face_list *f, const vertex_weld *w) {
    return (polygons){w->count, f->face_count, f->corner_count, f->sizes, f->points};
}

static bool allocate(face_list *f, const kiln_mesh *m, kiln_arena *arena) {
    *f = (face_list){.sizes = ARENA_ARRAY(arena, uint32_t, m->face_count),
                     .corners = ARENA_ARRAY(arena, uint32_t, m->corner_count),
                     .sources = ARENA_ARRAY(arena, uint32_t, m->face_count),
                     .points = ARENA_ARRAY(arena, uint32_t, m->corner_count)};
    return f->sizes && f->corners && f->sources && f->points;
}

static void open_face(face_list *f, uint32_t source) {
    f->sources[f->face_count] = source;
    f->sizes[f->face_count] = 0;
}

static void add_corner(face_list *f, uint32_t corner, uint32_t point) {
    f->corners[f->corner_count] = corner;
    f->points[f->corner_count++] = point;
    f->sizes[f->face_count]++;
}

/* The face stays unless a point repeats in it. */
static void close_face(face_list *f, bool drop_degenerate) {
    uint32_t size = f->sizes[f->face_count];
    const uint32_t *points = f->points + f->corner_count - size;
    bool degenerate = false;
    if (drop_degenerate && size <= 4) /* triangles and quads: larger polygons may touch themselves */
        for (uint32_t i = 0; i < size; i++)
            for (uint32_t j = 0; j < i; j++) degenerate |= points[i] == points[j];
    if (degenerate) f->corner_count -= size;
    else f->face_count++;
}

bool faces_take(const kiln_mesh *m, const vertex_weld *w, bool drop_degenerate, kiln_arena *arena, face_list *f) {
    if (!allocate(f, m, arena)) return false;
    for (uint32_t face = 0; face < m->face_count; face++) {
        open_face(f, face);
        for (uint32_t c = mesh_face_first(m, face), end = c + mesh_face_size(m, face); c < end; c++)
            add_corner(f, c, w->map[m->face_vertices[c]]);
        close_face(f, drop_degenerate);
    }
    return true;
}

bool faces_triangulate(const kiln_mesh *m, const vertex_weld *w, kiln_arena *arena, face_list *f) {
    uint32_t corner_count = 3 * m->triangle_count;
    *f = (face_list){.face_count = m->triangle_count,
                     .corner_count = corner_count,
                     .sizes = ARENA_ARRAY(arena, uint32_t, m->triangle_count),
                     .corners = ARENA_ARRAY(arena, uint32_t, corner_count),
                     .sources = ARENA_ARRAY(arena, uint32_t, m->triangle_count),
                     .points = ARENA_ARRAY(arena, uint32_t, corner_count)};
    bool room = f->sizes && f->corners && f->sources && f->points;
    if (!room || !mesh_triangulate(m, f->corners, f->sources)) return false;
    for (uint32_t t = 0; t < f->face_count; t++) f->sizes[t] = 3;
    for (uint32_t c = 0; c < corner_count; c++) f->points[c] = w->map[m->face_vertices[f->corners[c]]];
    return true;
}

bool faces_join_fans(const kiln_mesh *m, const vertex_weld *w, kiln_arena *arena, face_list *f) {
    if (!allocate(f, m, arena)) return false;
    const uint32_t *v = m->face_vertices;
    for (uint32_t t = 0; t < m->face_count;) {
        open_face(f, t);
        uint32_t first = 3 * t;
        for (uint32_t k = 0; k < 3; k++) add_corner(f, first + k, w->map[v[first + k]]);
        kiln_id material = mesh_face_material(m, t);
        for (t++; t < m->face_count; t++) {
            bool chained = v[3 * t] == v[first] && v[3 * t + 1] == v[3 * t - 1] && mesh_face_material(m, t) == material;
            if (!chained) break;
            add_corner(f, 3 * t + 2, w->map[v[3 * t + 2]]);
        }
        close_face(f, true);
    }
    return true;
}
